// The surface of a height map: heights in metres over a grid of texel centres, and the normals that light is
// received about. Frame: x right, y down the image rows, z up; texel (i, j) has its centre at ((i+½)t,
// (j+½)t).
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>

#include "core/grid.h"

namespace hemibake {

// The surroundings of the map: kWrap repeats it for ever, kOpen has nothing beyond the border, kGround has
// ground there that goes on level with the border: the sky ends at the horizontal plane.
enum class Edge { kWrap, kOpen, kGround };

// Returns index i as the edge continues an axis of n texels: modulo n, or the nearest of 0..n-1.
inline int wrap_or_clamp(int i, int n, Edge edge) {
  return edge == Edge::kWrap ? wrap_index(i, n) : std::clamp(i, 0, n - 1);
}

struct Surface {
  Grid<float> heights_m;    // along +z, lowest texel at 0
  Grid<glm::vec3> normals;  // unit length, z > 0: the shading normal of each texel
  double texel_size_m = 1;  // t = size / max(width, height)
  Edge edge = Edge::kWrap;
  // Of the heights' size, 1: no surface, although the heights go on smoothly there; empty: none.
  Grid<uint8_t> holes;

  int width() const { return heights_m.width; }
  int height() const { return heights_m.height; }
  uint32_t texel_count() const { return static_cast<uint32_t>(heights_m.size()); }
  // Returns whether a texel has no surface. x, y: in the map.
  bool is_hole(size_t texel) const { return !holes.empty() && holes[texel] != 0; }
  bool is_hole(int x, int y) const { return !holes.empty() && holes(x, y) != 0; }
};

// Largest map taken, texels: patch indices stay below 2^31.
inline constexpr uint64_t kMaxTexels = uint64_t{1} << 28;

// Makes the surface of a height map, with central-difference normals (surface/normals.h).
// heights: height-map values (0..1 by convention, any finite value works), at least one texel; open edges
// need 2 × 2. They may range over up to 10¹² texel sizes.
// size_m: along the longer side, 10⁻¹² to 10¹² m. amplitude_m: metres per unit of height, ≥ 0.
// Throws InputError (without a file name) for values out of these ranges.
Surface make_surface(Grid<float> heights, double size_m, double amplitude_m, Edge edge);

// Returns the highest minus the lowest height, metres.
double height_range_m(const Surface& surface);

// Returns the centre of a texel in units of texels: x = i, y = j, z = height / texel size.
glm::dvec3 texel_position_texels(const Surface& surface, uint32_t texel);

}  // namespace hemibake
