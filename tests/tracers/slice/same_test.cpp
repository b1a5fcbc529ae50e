// The slice tracer on every machine, at rare blockers, and with other seeds.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>

#include "support/maps.h"
#include "tracers/slice/instruction_sets.h"
#include "tracers/slice/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

SliceOptions azimuths(int count) {
  SliceOptions options;
  options.azimuths = count;
  return options;
}

LightTransport trace_all(const Surface& surface, const SliceOptions& options, bool with_links) {
  return trace_surface(*make_slice_tracer(surface, options), with_links ? KeptLinks::kAll : KeptLinks::kNone);
}

// One binary serves every x86-64 machine: each set of vector instructions that this one has gives the same
// numbers.
TEST(SliceRobustness, EveryInstructionSetSeesTheSame) {
  const Surface surface = white_noise_surface(40, 24, 0.1);
  const LightTransport best = trace_all(surface, azimuths(16), true);
  const auto light = [](const LightTransport& seen) {
    BounceOptions options;
    options.bounces = 1;
    return bounce_light(seen, options).irradiance[1].values;
  };
  const std::vector<float> best_light = light(best);
  for (const std::string& set : instruction_sets()) {
    use_instruction_set(set);
    const LightTransport seen = trace_all(surface, azimuths(16), true);
    EXPECT_EQ(seen.visible_fraction.values, best.visible_fraction.values) << set;
    EXPECT_EQ(seen.direct_over_pi.values, best.direct_over_pi.values) << set;
    EXPECT_EQ(seen.patch_direct_over_pi, best.patch_direct_over_pi) << set;
    EXPECT_EQ(light(seen), best_light) << set;
  }
  hwy::SetSupportedTargetsForTest(0);
}

// A thin pillar on flat ground blocks one or two azimuths of most nodes, or none. Wherever it does there are
// links, along whichever azimuths it was met, and E₀ is not changed by looking for them.
TEST(SliceRobustness, NodesThatSeeOnePillarLinkToIt) {
  Grid<float> heights(40, 40, 0.0f);
  heights(20, 20) = 1;
  const Surface surface = make_surface(std::move(heights), 1, 0.5, Edge::kOpen);
  const auto tracer = make_slice_tracer(surface, azimuths(16));
  Row with, without;
  TracerCounts counts;
  int blocked = 0;
  for (uint32_t patch = 0; patch < tracer->patch_set().count; patch += 5) {
    tracer->trace_patch(patch, true, with, counts);
    tracer->trace_patch(patch, false, without, counts);
    EXPECT_NEAR(with.direct_over_pi, without.direct_over_pi, 1e-4) << patch;
    EXPECT_EQ(with.links.empty(), with.direct_over_pi == 1) << patch;
    if (!with.links.empty()) ++blocked;
  }
  EXPECT_GT(blocked, 100);
}

// Another seed is another set of azimuths: nothing of the noise is shared, or it could not be told from two.
TEST(SliceRobustness, SeedsAreIndependent) {
  const Surface surface = white_noise_surface(48, 40, 0.1);
  const auto tracer = make_slice_tracer(surface, azimuths(16));
  const auto trace_again = [&](uint64_t seed) {
    return trace_surface(*tracer->reseeded(seed), KeptLinks::kAll);
  };
  const LightTransport truth = trace_all(surface, azimuths(512), true), first = trace_again(1),
                       second = trace_again(2);
  // The correlation of two independent errors of n values is 0 ± 1/√n; packets of 16 share their azimuths.
  const auto expect_uncorrelated = [](const std::vector<float>& a, const std::vector<float>& b,
                                      const std::vector<float>& right) {
    double ab = 0, aa = 0, bb = 0;
    for (size_t i = 0; i < right.size(); ++i) {
      const double x = static_cast<double>(a[i] - right[i]), y = static_cast<double>(b[i] - right[i]);
      ab += x * y;
      aa += x * x;
      bb += y * y;
    }
    EXPECT_LT(std::abs(ab) / std::sqrt(aa * bb), 4 / std::sqrt(static_cast<double>(right.size()) / 16));
  };
  expect_uncorrelated(first.direct_over_pi.values, second.direct_over_pi.values, truth.direct_over_pi.values);
  expect_uncorrelated(first.patch_direct_over_pi, second.patch_direct_over_pi, truth.patch_direct_over_pi);
}

}  // namespace
}  // namespace hemibake
