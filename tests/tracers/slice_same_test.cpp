// The slice tracer gives the same answer however it is asked and on every machine.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>

#include "support/maps.h"
#include "tracers/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

SliceOptions azimuths(int count) {
  SliceOptions options;
  options.azimuths = count;
  return options;
}

Visibility look(const Surface& surface, const SliceOptions& options, bool with_links) {
  return trace_surface(*make_slice_tracer(surface, options), surface.width(), surface.height(),
                       options.patches, with_links);
}

// One binary serves every x86-64 machine: each set of vector instructions that this one has gives the same
// light. Fused and plain multiply-adds round apart by some 10⁻⁷ of the heights.
TEST(SliceSame, EveryInstructionSetSeesTheSame) {
  const Surface surface = white_noise_surface(40, 24, 0.1);
  const Visibility best = look(surface, azimuths(16), true);
  const auto light = [](const Visibility& seen) {
    BounceOptions options;
    options.bounces = 1;
    return bounce_light(seen, options).irradiance[1];
  };
  const Grid<float> best_light = light(best);
  const int64_t all = hwy::SupportedTargets();
  int targets = 0;
  for (int64_t left = all; left != 0; left &= left - 1, ++targets) {
    const int64_t target = left & -left;
    hwy::SetSupportedTargetsForTest(target);
    const Visibility seen = look(surface, azimuths(16), true);
    const Grid<float> seen_light = light(seen);
    double difference = 0;
    for (size_t i = 0; i < surface.texel_count(); ++i) {
      EXPECT_NEAR(seen.visible_fraction[i], best.visible_fraction[i], 1e-5) << hwy::TargetName(target);
      EXPECT_NEAR(seen.direct_over_pi[i], best.direct_over_pi[i], 1e-5) << hwy::TargetName(target);
      difference += std::abs(static_cast<double>(seen_light[i]) - static_cast<double>(best_light[i]));
    }
    // A sample on an edge may fall to the facet beside it: a few in ten thousand links.
    EXPECT_LT(difference / surface.texel_count(), 1e-3) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  EXPECT_GT(targets, 0);
}

// What a tile of texels sees is what its texels see one by one: tiles cut off at both borders.
TEST(SliceSame, TilesSeeWhatTexelsSee) {
  const Surface surface = white_noise_surface(77, 35, 0.2);
  const auto tracer = make_slice_tracer(surface, azimuths(12));
  const Visibility seen = trace_surface(*tracer, 77, 35, Patches::kFacets, false);
  Row row;
  TracerCounts counts;
  for (uint32_t texel = 0; texel < surface.texel_count(); texel += 7) {
    tracer->trace_texel(texel, false, row, counts);
    EXPECT_EQ(static_cast<float>(row.visible_fraction), seen.visible_fraction[texel]) << texel;
    EXPECT_EQ(static_cast<float>(row.direct_over_pi), seen.direct_over_pi[texel]) << texel;
  }
  EXPECT_EQ(seen.counts.rays, 12u * surface.texel_count());
}

}  // namespace
}  // namespace hemibake
