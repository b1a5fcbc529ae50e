#include "tracers/slice/families.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

constexpr uint64_t kRotation = 0x511ce08;

// Paths of a family: azimuths times rotations. More rotations cover the circle better, but fewer packets then
// share a path. The families of nodes are rotated apart.
constexpr int kTexelPaths = 256, kCornerPaths = 128, kNodePaths = 32;
// Cached segments of a family.
constexpr int kCachedTexelSegments = 16384, kCachedCornerSegments = 4096, kCachedNodeSegments = 1024;
constexpr size_t kBytesPerCachedSegment = 560;  // about 22 crossings and their facets, and the corners

// Azimuths of a corner over those of other nodes: the corners next to a texel make most of its first bounce,
// and their light is the sky they see. Their form factors lead on to many others: sampled along every second
// one.
constexpr int kCornerFactor = 2;

// Texels: a hit of a node on a facet that touches it counts as so far away. With less, nodes in deep folds
// see little but each other, and light stays there longer than it does along a facet that brightens away from
// the fold; with more it leaves too early (README.md).
constexpr double kLeastNodeDistance = 0.0075;

// Returns the azimuths of a node: at least ten, with fewer, nodes in deep folds see only each other; twice an
// odd number, which integrates the cosine weight of a tilted facet well (odd harmonics above the first
// vanish).
int azimuths_of_node(int azimuths) { return 2 * std::max(5, azimuths / 20 | 1); }

// Returns the offset of a rotation in its share of the circle, 0..1: random, but nowhere near an eighth, so
// that no path runs exactly along the grid or a diagonal. On a wrapping map such a path meets the same few
// texels for ever, and goes on to the far limit if the highest is not among them.
double rotation_offset(uint64_t seed, uint64_t family) {
  const double random = unit_interval(mix_bits(seed, kRotation, family)), eighth = std::floor(8 * random);
  return (eighth + 0.25 + 0.5 * (8 * random - eighth)) / 8;
}

// Makes a family of make_path(rotation, azimuth, angle). offset: of the first angle, in steps of rotation,
// 0..1.
template <class MakePath>
SlicePaths make_paths(int azimuths, int wanted_paths, double offset, const MakePath& make_path) {
  SlicePaths family;
  family.azimuths = azimuths;
  family.rotations = std::max(1, wanted_paths / azimuths);
  for (int rotation = 0; rotation < family.rotations; ++rotation)
    for (int azimuth = 0; azimuth < azimuths; ++azimuth)
      family.paths.push_back(make_path(
          rotation, azimuth, 2 * kPi * (azimuth + (rotation + offset) / family.rotations) / azimuths));
  return family;
}

void reserve_cache(int segments, SlicePaths& family) {
  family.cache = std::make_shared<CachedSegments>();
  family.cache->per_path = std::max(1, segments / static_cast<int>(family.paths.size()));
}

SlicePaths make_texel_paths(int azimuths, uint64_t seed) {
  SlicePaths family = make_paths(azimuths, kTexelPaths, rotation_offset(seed, 0), [](int, int, double angle) {
    return make_slice_path({0, 0}, angle, false);
  });
  reserve_cache(kCachedTexelSegments, family);
  return family;
}

// Makes the family of the nodes at a site.
SlicePaths make_node_paths(int azimuths, uint64_t seed, uint32_t site) {
  const NodeSite& place = kNodeSites.sites[site];
  const glm::dvec2 start = glm::dvec2(place.x, place.y) / 4.0;
  const auto make_path = [&](int, int, double angle) {
    return make_slice_path(start, angle, place.slots == 1);
  };
  const bool corner = site == 0;
  SlicePaths family =
      make_paths((corner ? kCornerFactor : 1) * azimuths_of_node(azimuths),
                 corner ? kCornerPaths : kNodePaths, rotation_offset(seed, 1 + site), make_path);
  family.least_distance = kLeastNodeDistance;
  family.hit_azimuth_stride = corner ? kCornerFactor : 1;
  reserve_cache(corner ? kCachedCornerSegments : kCachedNodeSegments, family);
  return family;
}

}  // namespace

SliceFamilies make_slice_families(int azimuths, PatchKind patches, uint64_t seed) {
  SliceFamilies families;
  families.texels = make_texel_paths(azimuths, seed);
  if (patches != PatchKind::kFacets) return families;
  for (uint32_t site = 0; site < kSites; ++site)
    families.nodes.push_back(make_node_paths(azimuths, seed, site));
  return families;
}

size_t cache_bytes(const SlicePaths& paths) {
  return paths.paths.size() * static_cast<size_t>(paths.cache->per_path) * kBytesPerCachedSegment;
}

}  // namespace hemibake
