// Options shared by the tracers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "sampling/directions.h"
#include "surface/patches.h"
#include "tracers/tracer.h"

namespace hemibake {

// Rays of all nodes of a facet over those of a texel: twice this, and the texels' own rays, is what bounces
// cost over the texels' rays alone.
inline constexpr double kFacetRays = 1.2;

// Rays of each node of a facet that is cut into k² triangles. Of fewer than eight, or of all where a texel has
// no more, some in a deep fold would only meet each other and keep their light for ever.
inline int rays_per_node(int rays, int k) {
  return std::max(std::min(rays, 8), static_cast<int>(std::lround(kFacetRays * rays / node_count(k))));
}

// Steps of the golden ratio: any number of them is spread evenly over the unit interval.
inline constexpr double kGoldenStep = 0.6180339887498949;

// How a hit becomes links where patches are texels: to the nearest texel, or spread over the four around it.
enum class TexelLinks { kNearest, kBilinear };

struct RayOptions {
  int rays = 256;             // per texel, 1..2^20; per node see rays_per_node
  double cone_degrees = 180;  // full aperture about the normal, (0, 180]
  double max_distance_m = std::numeric_limits<double>::infinity();  // hits beyond are sky, > 0
  DirectionSet directions = DirectionSet::kUniform;                 // of texels; nodes always use kCosine
  Patches patches = Patches::kFacets;
  TexelLinks texel_links = TexelLinks::kBilinear;
  uint64_t seed = 0;
};

}  // namespace hemibake
