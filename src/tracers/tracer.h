// What a tracer answers: how much sky a receiver sees, how much light that is, and which patches block the
// rest.
//
// Receivers are texels (with their shading normals) and patches (surface/patches.h), what light is re-emitted
// by: nodes on the facets of the surface, or the texels themselves, with the same index as the texel.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "surface/patches.h"

namespace hemibake {

// E_{b+1} of the receiver gets weight · E_b of the patch.
struct FormFactor {
  uint32_t patch;
  float weight;
};

// What one receiver sees. Σ weights + direct_over_pi = 1 to rounding (with the march's published weights up
// to 2, see tracers/march/march.h).
struct Row {
  double visible_fraction = 0;    // α, uniform fraction of the hemisphere about the normal that is sky, 0..1
  double direct_over_pi = 0;      // E₀/π, cosine-weighted fraction, 0..1
  glm::dvec3 bent_normal{0};      // unit mean direction of the sky seen; the normal itself where none is seen
  std::vector<FormFactor> links;  // ascending by patch, each patch once; empty where links were not asked for
};

// One ray of a texel, for replay.
struct RayRecord {
  glm::dvec3 direction;   // unit, world frame
  double cosine_weight;   // share of E₀/π, or of the links
  double uniform_weight;  // share of α
  bool hit;
  uint32_t facet;        // where hit
  glm::dvec2 hit_texel;  // where hit: position in texels, texel centres at integers, wrapped into the map
  double distance_m;     // where hit: along the ray
  int tiles_crossed;     // map copies entered after the first
};

struct TracerCounts {
  uint64_t rays = 0;  // rays (or azimuths) traced
  uint64_t truncated =
      0;  // rays still below the highest texel where the tracer stops following them, taken for sky
};

struct TexelTile {
  uint32_t x, y, width, height;
};

// A surface made ready for tracing. Safe to call from many threads; the answer depends on the receiver only.
class Tracer {
 public:
  virtual ~Tracer() = default;
  // The surface the tracer was made for.
  virtual const Surface& surface() const = 0;
  // The patches that form factors lead to.
  virtual const PatchSet& patch_set() const = 0;
  // Fills `row`, its links only if `with_links`. Adds to `counts`.
  virtual void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const = 0;
  virtual void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const = 0;
  // Rows of the receivers first, first + 1, …: the same as one by one, for tracers that answer neighbours
  // together.
  virtual void trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                            TracerCounts& counts) const {
    for (size_t i = 0; i < rows.size(); ++i)
      trace_texel(first + static_cast<uint32_t>(i), with_links, rows[i], counts);
  }
  // Rows without links of a tile of the map, one row of the tile after the other:
  // the same as one by one, for tracers that answer receivers near each other faster.
  virtual void trace_tile(const TexelTile& tile, std::span<Row> rows, TracerCounts& counts) const {
    const uint32_t map_width = static_cast<uint32_t>(surface().width());
    for (uint32_t j = 0; j < tile.height; ++j)
      trace_texels((tile.y + j) * map_width + tile.x, false, rows.subspan(j * tile.width, tile.width),
                   counts);
  }
  virtual void trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                             TracerCounts& counts) const {
    for (size_t i = 0; i < rows.size(); ++i)
      trace_patch(first + static_cast<uint32_t>(i), with_links, rows[i], counts);
  }
  // The same with other random rotations, on the same surface: to tell noise. Shares what is large.
  virtual std::unique_ptr<Tracer> reseeded(uint64_t seed) const = 0;
  // Every ray trace_texel shoots for this texel, in order.
  virtual std::vector<RayRecord> replay_texel(uint32_t texel) const = 0;
};

}  // namespace hemibake
