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

// Rays of all nodes of a facet over those of a texel. Bounces cost twice this (two facets a texel), and the
// texels' own rays.
inline constexpr double kFacetRays = 0.6;

// Rays of a node at a corner of its facet over those of any other: the texel there sees the corners of six
// facets from next to it, and their noise with them.
inline constexpr double kCornerRays = 3;

// Returns the rays of a node of a facet that is cut into k² triangles. rays: of a texel.
// At least min(rays, 8): with fewer, nodes in deep folds see only each other and keep their light for ever.
inline int rays_per_node(int rays, int k, uint32_t node) {
  const double rays_of_others = kFacetRays * rays / (node_count(k) - 3 + 3 * kCornerRays);
  const double wanted = (is_corner(node) ? kCornerRays : 1) * rays_of_others;
  return std::max(std::min(rays, 8), static_cast<int>(std::lround(wanted)));
}

// Returns the kind of a node, 0 … kNodeKinds − 1: corner or not, of a coarsely or finely cut facet. Nodes of
// one kind have equally many rays.
inline constexpr size_t kNodeKinds = 4;
constexpr size_t node_kind(int k, uint32_t node) {
  return (k == kFineSubdivision ? 2 : 0) + (is_corner(node) ? 1 : 0);
}

// Golden-ratio step: any number of steps is spread evenly over the unit interval.
inline constexpr double kGoldenStep = 0.6180339887498949;

// Share of a hit among texels, where they are the patches: the nearest, or the four around it.
enum class TexelLinks { kNearest, kBilinear };

struct RayOptions {
  int rays = 256;             // per texel, 1..2^20; per node see rays_per_node
  double cone_degrees = 180;  // full aperture about the normal, (0, 180]
  double max_distance_m =
      std::numeric_limits<double>::infinity();       // hits beyond are sky, > 0; none with ground edges
  DirectionSet directions = DirectionSet::kUniform;  // of texels; nodes always use kCosine
  PatchKind patch_kind = PatchKind::kFacets;
  TexelLinks texel_links = TexelLinks::kBilinear;
  uint64_t seed = 0;
};

}  // namespace hemibake
