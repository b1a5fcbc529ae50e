#include "tracers/slice/families.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "sampling/low_discrepancy.h"
#include "sampling/warp.h"

namespace hemibake {
namespace {

constexpr uint64_t kTurn = 0x511ce08, kNodeShift = 0x511ce02;

// Paths of a family: azimuths times rotations. With fewer azimuths more rotations, so that all receivers
// together see the whole circle; with more rotations fewer packets share a path. The families of nodes are
// rotated apart.
constexpr int kTexelPaths = 256, kNodePaths = 32;
// Segments kept ready in a family. There is one family of texels and 30 of nodes.
constexpr int kReadyTexelSegments = 16384, kReadyNodeSegments = 1024;
constexpr size_t kBytesPerReadySegment = 560;  // about 22 crossings and their facets, and the corners

// What a node sees of the sky is the light of its patch, and the few nodes next to a texel, most of all those
// at the corners there, make most of its first bounce: corners have twice the azimuths. FormFactorMatrix only
// lead on to many others: corners look for them along every second one. (Along half as many again a bake
// costs a twentieth less, and its second bounce has a fifth more noise.)
constexpr int kCornerFactor = 2;

// Azimuths of a node: ten at least, or some in a deep fold would only meet each other and keep their light
// for ever; twice an odd number, which integrates the cosine weight of a tilted facet well (its odd harmonics
// above the first vanish).
int azimuths_of_node(int azimuths) { return 2 * std::max(5, azimuths / 20 | 1); }

// Where in its share of the circle a turn begins, 0..1: at random, but nowhere near an eighth, so that no
// path runs exactly along the grid or a diagonal. On a wrapping map such a path meets the same few texels for
// ever, and is followed to the far limit where the highest one is not among them.
double turn_offset(uint64_t seed, uint64_t family) {
  const double random = unit_interval(mix_bits(seed, kTurn, family)), eighth = std::floor(8 * random);
  return (eighth + 0.25 + 0.5 * (8 * random - eighth)) / 8;
}

// Calls add(turn, azimuth, angle) for every path of a family.
template <class Add>
SlicePaths make_paths(int azimuths, int wanted_paths, double offset, const Add& make_path) {
  SlicePaths family;
  family.azimuths = azimuths;
  family.turns = std::max(1, wanted_paths / azimuths);
  for (int turn = 0; turn < family.turns; ++turn)
    for (int azimuth = 0; azimuth < azimuths; ++azimuth)
      family.paths.push_back(
          make_path(turn, azimuth, 2 * kPi * (azimuth + (turn + offset) / family.turns) / azimuths));
  return family;
}

void keep_ready(int segments, SlicePaths& family) {
  family.ready = std::make_shared<ReadySegments>();
  family.ready->per_path = std::max(1, segments / static_cast<int>(family.paths.size()));
}

SlicePaths make_texel_paths(int azimuths, uint64_t seed) {
  SlicePaths family = make_paths(azimuths, kTexelPaths, turn_offset(seed, 0), [](int, int, double angle) {
    return make_slice_path({0, 0}, angle, false);
  });
  keep_ready(kReadyTexelSegments, family);
  return family;
}

// Each azimuth starts from another low-discrepancy point of the small copy of the facet at the node.
SlicePaths make_node_paths(int azimuths, uint64_t seed, uint32_t half, uint32_t node) {
  const auto make_path = [&](int turn, int azimuth, double angle) {
    const uint64_t place = 2 * static_cast<uint64_t>(turn);
    const double shift_u = unit_interval(mix_bits(seed, kNodeShift, place));
    const double shift_v = unit_interval(mix_bits(seed, kNodeShift, place + 1));
    const uint32_t index = static_cast<uint32_t>(azimuth);
    const glm::dvec2 point =
        sample_uniform_triangle({cranley_patterson_rotate(radical_inverse(2, index), shift_u),
                                 cranley_patterson_rotate(radical_inverse(3, index), shift_v)});
    const glm::dvec2 uv = node_start_uv(node, point);
    return make_slice_path(half == 0 ? uv : 1.0 - uv, angle, true);
  };
  const int factor = is_corner(node) ? kCornerFactor : 1;
  SlicePaths family = make_paths(factor * azimuths_of_node(azimuths), kNodePaths,
                                 turn_offset(seed, 1 + node_family(half, node)), make_path);
  family.azimuths_per_linked = factor;
  keep_ready(kReadyNodeSegments, family);
  return family;
}

}  // namespace

SliceFamilies make_slice_families(int azimuths, PatchKind patches, uint64_t seed) {
  SliceFamilies families;
  families.texels = make_texel_paths(azimuths, seed);
  if (patches != PatchKind::kFacets) return families;
  for (uint32_t half = 0; half < 2; ++half)
    for (uint32_t node = 0; node < kFineNodes; ++node)
      families.nodes.push_back(make_node_paths(azimuths, seed, half, node));
  return families;
}

size_t ready_bytes(const SlicePaths& paths) {
  return paths.paths.size() * static_cast<size_t>(paths.ready->per_path) * kBytesPerReadySegment;
}

size_t node_family(uint32_t half, uint32_t node) { return half * kFineNodes + node; }

}  // namespace hemibake
