#include "trade/reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/maps.h"
#include "tracers/slice/slice.h"
#include "trade/errors.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

ReferenceOptions quick() {
  ReferenceOptions options;
  options.effort = Effort::kQuick;
  return options;
}

TEST(Reference, StatesItsOwnErrorHonestly) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 24, 24, 0.1);
  const Reference reference = make_reference(surface, quick());
  // Against many times as many azimuths, none of them the reference's.
  SliceOptions slices;
  slices.azimuths = 2003;
  slices.seed = 99;
  const LightTransport truth = trace_surface(*make_slice_tracer(surface, slices), KeptLinks::kNone);
  const double of_ao = error_of(reference.planes.uniform.values, truth.visible_fraction.values, {}).rmse;
  const double of_direct = error_of(reference.planes.cosine.values, truth.direct_over_pi.values, {}).rmse;
  // An rms over 576 texels from one pair of seeds; neighbours share azimuths in sixteens, so it is known to
  // about 1/√(2·36) = 12 %: within a factor 1.5 at four of these. The finer truth has a hundredth of it.
  EXPECT_NEAR(std::log(of_ao / reference.facts.error[kAoPlane]), 0, std::log(1.5));
  EXPECT_NEAR(std::log(of_direct / reference.facts.error[kDirectPlane]), 0, std::log(1.5));
}

TEST(Reference, IsFiveTimesBetterThanTheBestRun) {
  const Surface surface = synthetic_surface(SyntheticKind::kShapes, 24, 16, 0.45);
  const Reference reference = make_reference(surface, quick());
  for (size_t p = 0; p < kPlaneCount; ++p)
    EXPECT_LE(reference.facts.error[p],
              std::max(kReferenceShare * reference.facts.best_run_error[p], kRoundingError))
        << named_planes()[p].name;
}

// What a plain bake would say of the same map: sums of light grow with the albedo, and stay below 1.
TEST(Reference, LightGrowsWithTheAlbedo) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 16, 16, 0.2);
  const RunPlanes planes = make_reference(surface, quick()).planes;
  for (size_t i = 0; i < planes.cosine.size(); ++i) {
    ASSERT_GE(planes.all_bounces[0][i], planes.cosine[i] - 1e-3);
    for (size_t a = 1; a < kJudgedAlbedos.size(); ++a)
      ASSERT_GT(planes.all_bounces[a][i], planes.all_bounces[a - 1][i]);
    ASSERT_LE(planes.all_bounces.back()[i], 1 + 1e-3);
  }
}

TEST(Reference, FlatGroundIsExact) {
  const Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8, 0.0);
  const Reference reference = make_reference(surface, quick());
  for (const float value : reference.planes.uniform.values) EXPECT_NEAR(value, 1, 1e-6);
  EXPECT_LE(reference.facts.error[kAoPlane], 1e-6);
  EXPECT_FALSE(reference.facts.models.bounded);
}

// Where the links of more azimuths do not fit, seeds are added.
TEST(Reference, KeepsToItsMemory) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 16, 16, 0.2);
  ReferenceOptions small = quick();
  small.memory_bytes = 1;
  const Reference reference = make_reference(surface, small);
  EXPECT_EQ(reference.facts.azimuths_light, top_light_azimuths(Effort::kQuick));
  EXPECT_GT(reference.facts.seeds_light, 2);
}

}  // namespace
}  // namespace hemibake
