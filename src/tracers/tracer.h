// The interface of all tracers: sky, direct light and form factors of one receiver after another.
//
// Receivers are texels (with their shading normals) and patches (surface/patches.h), which re-emit light:
// nodes on the facets of the surface, or the texels themselves, with the same index as the texel.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "surface/patches.h"

namespace hemibake {

// Share of a receiver's light that comes from a patch: E_{b+1} of the receiver gets weight · E_b of the
// patch.
struct FormFactor {
  uint32_t patch;
  float weight;
};

// Sky and form factors of one receiver. Σ weights + direct_over_pi = 1 to rounding (up to 2 with the weights
// of 2018, see tracers/march/march.h).
struct Row {
  double visible_fraction = 0;  // α, uniform fraction of the hemisphere about the normal that is sky, 0..1
  double direct_over_pi = 0;    // E₀/π, cosine-weighted fraction, 0..1
  glm::dvec3 bent_normal{0};  // unit mean direction of the visible sky; the normal itself where there is none
  std::vector<FormFactor> links;  // ascending by patch, each patch once; empty where not asked for
};

// One ray of a texel, for replay.
struct RayRecord {
  glm::dvec3 direction;   // unit, world frame
  double cosine_weight;   // share of E₀/π, or of the form factors
  double uniform_weight;  // share of α
  bool hit;
  uint32_t facet;        // of the hit
  glm::dvec2 hit_texel;  // of the hit: position in texels, texel centres at integers, wrapped into the map
  double distance_m;     // of the hit: along the ray
  int tiles_crossed;     // map copies entered after the first
};

struct TracerCounts {
  uint64_t rays = 0;       // rays (or azimuths) traced
  uint64_t truncated = 0;  // of them, given up below the highest texel and taken for sky
};

struct TexelTile {
  uint32_t x, y, width, height;
};

// A surface prepared for tracing. Safe to call from many threads; a row depends on its receiver only, however
// it is asked for. All trace functions fill their rows, form factors only if `with_links`, and add to
// `counts`.
class Tracer {
 public:
  virtual ~Tracer() = default;
  // Returns the surface the tracer was made for.
  virtual const Surface& surface() const = 0;
  // Returns the patches that form factors lead to.
  virtual const PatchSet& patch_set() const = 0;
  // Traces one texel, or one patch.
  virtual void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const = 0;
  virtual void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const = 0;
  // Traces the texels first, first + 1, …; overridden by tracers that trace neighbours together.
  virtual void trace_texels(uint32_t first, bool with_links, std::span<Row> rows,
                            TracerCounts& counts) const {
    for (size_t i = 0; i < rows.size(); ++i)
      trace_texel(first + static_cast<uint32_t>(i), with_links, rows[i], counts);
  }
  // Traces a tile of the map without form factors; rows: tile row by tile row.
  virtual void trace_tile(const TexelTile& tile, std::span<Row> rows, TracerCounts& counts) const {
    const uint32_t map_width = static_cast<uint32_t>(surface().width());
    for (uint32_t j = 0; j < tile.height; ++j)
      trace_texels((tile.y + j) * map_width + tile.x, false, rows.subspan(j * tile.width, tile.width),
                   counts);
  }
  // Traces the patches first, first + 1, …
  virtual void trace_patches(uint32_t first, bool with_links, std::span<Row> rows,
                             TracerCounts& counts) const {
    for (size_t i = 0; i < rows.size(); ++i)
      trace_patch(first + static_cast<uint32_t>(i), with_links, rows[i], counts);
  }
  // Returns a tracer of the same surface with other random rotations, to measure noise; shares large data.
  virtual std::unique_ptr<Tracer> reseeded(uint64_t seed) const = 0;
  // Returns every ray that trace_texel shoots for this texel, in order, but those to ground beyond the
  // border.
  virtual std::vector<RayRecord> replay_texel(uint32_t texel) const = 0;
};

}  // namespace hemibake
