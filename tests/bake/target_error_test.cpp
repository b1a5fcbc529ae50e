#include "bake/target_error.h"

#include <gtest/gtest.h>

#include "support/maps.h"
#include "tracers/slice/slice.h"
#include "trade/scored_run.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

TargetOptions slice_target(const Surface& surface, double error) {
  TargetOptions options;
  options.error = error;
  options.make_tracer = [&surface](int azimuths, uint64_t seed) {
    SliceOptions slices;
    slices.azimuths = azimuths;
    slices.seed = seed;
    return make_slice_tracer(surface, slices);
  };
  return options;
}

LightTransport trace(const TargetOptions& options, int rays, uint64_t seed) {
  return trace_surface(*options.make_tracer(rays, seed),
                       options.with_light ? KeptLinks::kAll : KeptLinks::kNone);
}

// Over the whole map, against a bake with many azimuths and bounces.
double true_error(const TargetOptions& options, const LightTransport& seen, int bounces) {
  const auto planes_of = [](const LightTransport& v, int count) {
    RunPlanes planes;
    planes.uniform = v.visible_fraction;
    planes.cosine = v.direct_over_pi;
    BounceOptions bounce;
    bounce.bounces = count;
    add_bounces(bounce_light(v, bounce).irradiance, planes);
    planes.first_bounce = {};
    return planes;
  };
  const RunPlanes truth = planes_of(trace(options, 301, 7), 200);
  double worst = 0;
  for (const auto& error : errors_of(planes_of(seen, bounces), truth))
    if (error) worst = std::max(worst, error->rmse);
  return worst;
}

// Held out: another seed than the pilot's, and every texel.
void expect_reached(const Surface& surface, double error) {
  const TargetOptions options = slice_target(surface, error);
  const TargetChoice choice = choose_for_target(surface, options);
  ASSERT_TRUE(choice.reachable);
  const LightTransport chosen = trace(options, choice.rays, 99);
  const double reached = true_error(options, chosen, choice.bounces);
  EXPECT_LE(reached, 1.25 * error) << choice.rays << " rays, " << choice.bounces << " bounces";
  // Half as many would not have done: what was chosen is at most twice the cheapest.
  EXPECT_GT(true_error(options, trace(options, choice.rays / 2, 99), choice.bounces), error)
      << choice.rays << " rays, " << choice.bounces << " bounces";
  // What the bake says of itself, from a sample: within the chance of 12 % that 36 blocks leave, at three.
  const double stated = measure_reached(surface, chosen, choice.bounces, options).worst();
  EXPECT_NEAR(stated / reached, 1, 0.4);
}

TEST(TargetError, IsReachedOnARoughMap) {
  expect_reached(synthetic_surface(SyntheticKind::kBricks, 32, 32, 0.1), 0.005);
}

TEST(TargetError, IsReachedOnASmoothMap) {
  expect_reached(synthetic_surface(SyntheticKind::kShapes, 32, 32, 0.45), 0.01);
}

TEST(TargetError, OfSkyAloneNeedsNoBounces) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 32, 32, 0.1);
  TargetOptions options = slice_target(surface, 0.005);
  options.with_light = false;
  const TargetChoice choice = choose_for_target(surface, options);
  EXPECT_EQ(choice.bounces, 0);
  EXPECT_GT(choice.rays, 0);
  EXPECT_FALSE(choice.with_light);
}

TEST(TargetError, SmallerOnesTakeMore) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 32, 24, 0.1);
  const TargetChoice coarse = choose_for_target(surface, slice_target(surface, 0.02));
  const TargetChoice fine = choose_for_target(surface, slice_target(surface, 0.004));
  EXPECT_LT(coarse.rays, fine.rays);
  EXPECT_LT(coarse.bounces, fine.bounces);
  EXPECT_LE(fine.truncation, 0.25 * 0.004);
}

TEST(TargetError, FlatGroundTakesTheFewest) {
  const Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8, 0.0);
  const TargetOptions options = slice_target(surface, 0.001);
  const TargetChoice choice = choose_for_target(surface, options);
  EXPECT_EQ(choice.rays, options.fewest_rays);
  EXPECT_EQ(choice.bounces, 1);
  EXPECT_LT(choice.pilot.size(), 2u);
}

TEST(TargetError, SaysWhereItCannotBeReached) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 32, 32, 0.1);
  TargetOptions options = slice_target(surface, 0.001);
  options.most_rays = 8;
  const TargetChoice choice = choose_for_target(surface, options);
  EXPECT_FALSE(choice.reachable);
  EXPECT_EQ(choice.rays, 8);
}

}  // namespace
}  // namespace hemibake
