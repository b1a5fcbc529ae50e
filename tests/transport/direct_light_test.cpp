#include "transport/direct_light.h"

#include <gtest/gtest.h>

#include "support/maps.h"
#include "tracers/slice/slice.h"

namespace hemibake {
namespace {

TEST(DirectLight, IsBounceLightOfNoBounces) {
  const Surface surface = white_noise_surface(33, 17, 0.2);
  const LightTransport transport = trace_surface(*make_slice_tracer(surface, {}), KeptLinks::kNone);
  BounceOptions options;
  options.bounces = 0;
  const Bounces expected = bounce_light(transport, options), actual = direct_light(transport);
  ASSERT_EQ(actual.irradiance.size(), 1u);
  EXPECT_EQ(actual.irradiance[0].values, expected.irradiance[0].values);
  EXPECT_EQ(actual.total.values, expected.total.values);
  EXPECT_EQ(actual.residual.values, expected.residual.values);
  EXPECT_EQ(actual.mean_residual, expected.mean_residual);
  EXPECT_EQ(actual.worst_residual, expected.worst_residual);
  EXPECT_EQ(actual.worst_texel, expected.worst_texel);
  EXPECT_EQ(actual.bounces_made, 0);
}

}  // namespace
}  // namespace hemibake
