// The light of all bounces at one albedo, as the bounce map keeps it, against the solver and closed forms.
#include "transport/light_at_albedo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/maps.h"
#include "support/sliced.h"
#include "transport/albedo_light.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

double largest_difference(const LightTransport& transport, const Grid<float>& light, double albedo) {
  const std::vector<float> everywhere(transport.bounce_matrix().rows, static_cast<float>(albedo));
  AlbedoOptions options;
  options.tolerance = 1e-9;
  const AlbedoLight solved = bounce_with_albedo(transport, everywhere, options);
  double worst = 0;
  for (size_t i = 0; i < light.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(light[i]) - solved.texel_light[i]));
  return worst;
}

TEST(LightAtAlbedo, IsTheSolversHoweverManyBouncesAreStored) {
  const Surface surfaces[] = {white_noise_surface(24, 20, 0.5), white_noise_surface(24, 20, 1e-6),
                              white_noise_surface(16, 16, 1000),
                              synthetic_surface(SyntheticKind::kBricks, 48, 48, 0.3)};
  for (const Surface& surface : surfaces) {
    const LightTransport transport = sliced(surface);
    for (const double albedo : {0.5, 0.9, 0.95})
      for (const int stored : {0, 1, 20}) {
        const Bounces bounces = bounce_light(transport, {stored, std::nullopt, 2000, albedo});
        EXPECT_LT(largest_difference(transport, bounces.at_albedo, albedo), 1e-4)
            << albedo << ", " << stored << " bounces stored";
      }
  }
}

TEST(LightAtAlbedo, FlatGroundHasItsSkyAndNothingMore) {
  const Bounces bounces =
      bounce_light(sliced(synthetic_surface(SyntheticKind::kFlat, 8, 8)), {2, std::nullopt, 2000, 0.9});
  for (const float light : bounces.at_albedo.values) EXPECT_EQ(light, 1.0f);
}

TEST(LightAtAlbedo, ConvergingBesideItLeavesIt) {
  const LightTransport transport = sliced(white_noise_surface(16, 16, 0.3));
  const Bounces alone = bounce_light(transport, {4, std::nullopt, 2000, 0.9});
  const Bounces beside = bounce_light(transport, {4, 1e-4, 2000, 0.9});
  EXPECT_EQ(alone.at_albedo.values, beside.at_albedo.values);
}

}  // namespace
}  // namespace hemibake
