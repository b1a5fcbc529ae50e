// Options shared by the tracers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "sampling/directions.h"
#include "surface/patches.h"
#include "tracers/tracer.h"

namespace hemibake {

// Rays of all nodes of a facet over those of a texel: twice this, and the texels' own rays, is what bounces
// cost over the texels' rays alone.
inline constexpr double kFacetRays = 0.6;

// Rays of a node at a corner of its facet over those of any other. The texel there sees the corners of the
// six facets around it from next to it, and their noise with them: the first bounce of rough maps is a fifth
// more exact than with all nodes alike.
inline constexpr double kCornerRays = 3;

// Rays of a node of a facet that is cut into k² triangles. Of fewer than eight, or of all where a texel has
// no more, some in a deep fold would only meet each other and keep their light for ever.
inline int rays_per_node(int rays, int k, uint32_t node) {
  const double rays_of_others = kFacetRays * rays / (node_count(k) - 3 + 3 * kCornerRays);
  const double wanted = (is_corner(node) ? kCornerRays : 1) * rays_of_others;
  return std::max(std::min(rays, 8), static_cast<int>(std::lround(wanted)));
}

// Nodes that have as many rays as each other, 0 … kNodeKinds − 1: the corners and the others of facets cut
// alike.
inline constexpr size_t kNodeKinds = 4;
constexpr size_t node_kind(int k, uint32_t node) {
  return (k == kFineSubdivision ? 2 : 0) + (is_corner(node) ? 1 : 0);
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
  PatchKind patch_kind = PatchKind::kFacets;
  TexelLinks texel_links = TexelLinks::kBilinear;
  uint64_t seed = 0;
};

}  // namespace hemibake
