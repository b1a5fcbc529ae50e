// The surface of a height map: heights in metres over a grid of texel centres, and the normal light is
// received about. Frame: x right, y down the image rows, z up; texel (i, j) has its centre at ((i+½)t,
// (j+½)t).
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

#include "core/grid.h"

namespace hemibake {

// What lies beyond the border: the map again and again, or nothing.
enum class Edge { kWrap, kOpen };

struct Surface {
  Grid<float> heights_m;    // along +z, lowest texel at 0
  Grid<glm::vec3> normals;  // unit length, z > 0: the shading normal of each texel
  double texel_size_m = 1;  // t = size / max(width, height)
  Edge edge = Edge::kWrap;

  int width() const { return heights_m.width; }
  int height() const { return heights_m.height; }
  uint32_t texel_count() const { return static_cast<uint32_t>(heights_m.size()); }
};

// The largest map the tool takes, texels: patch indices (two facets a texel) stay below 2^31.
inline constexpr uint64_t kMaxTexels = uint64_t{1} << 28;

// heights: height-map values (0..1 by convention, any finite value works), at least one texel; open edges
// need 2 × 2. size_m: metres along the longer side, 10⁻¹² to 10¹². amplitude_m ≥ 0: metres per unit of
// height. The heights may range over up to 10¹² texel sizes. Normals are the central differences of the
// heights (surface/normals.h). Throws InputError (without a file name) for what it cannot take.
Surface make_surface(Grid<float> heights, double size_m, double amplitude_m, Edge edge);

// Highest minus lowest height, metres.
double height_range_m(const Surface& surface);

}  // namespace hemibake
