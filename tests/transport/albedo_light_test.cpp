#include "transport/albedo_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "support/maps.h"
#include "tracers/slice/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

LightTransport see(const Surface& surface, PatchKind patches) {
  SliceOptions options;
  options.azimuths = 8;
  options.patch_kind = patches;
  return trace_surface(*make_slice_tracer(surface, options), KeptLinks::kAll);
}

std::vector<float> everywhere(const LightTransport& transport, float albedo) {
  return std::vector<float>(transport.bounce_matrix().rows, albedo);
}

AlbedoOptions bounces(int count) {
  AlbedoOptions options;
  options.bounces = count;
  return options;
}

// Two patches that see each other with weight 1 − c: E_i = (c + (1 − c) a_j c) / (1 − (1 − c)² a_i a_j).
TEST(AlbedoLight, TwoPatchesHaveAClosedForm) {
  constexpr float c = 0.25f;
  LightTransport transport;
  transport.direct_over_pi = Grid<float>(2, 1, c);
  transport.final_gather = make_form_factors(2, 2);
  for (uint32_t i = 0; i < 2; ++i)
    append_row(transport.final_gather.blocks[0], std::vector<FormFactor>{{1 - i, 1 - c}});
  finish_blocks(transport.final_gather);
  const std::vector<float> albedo{0.5f, 1.0f};
  const AlbedoLight light = bounce_with_albedo(transport, albedo, {});
  const double loop = 1 - 0.75 * 0.75 * 0.5;
  EXPECT_NEAR(light.patch_light[0], (0.25 + 0.75 * 1.0 * 0.25) / loop, 0.25e-6);
  EXPECT_NEAR(light.patch_light[1], (0.25 + 0.75 * 0.5 * 0.25) / loop, 0.25e-6);
  EXPECT_LE(light.missing, 1e-6);
  EXPECT_EQ(light.texel_light.size(), 2u);
}

// One albedo for all: Σ ρᵇ E_b of the stored bounces.
TEST(AlbedoLight, OneAlbedoIsThePowerSeriesOfTheBounces) {
  for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels}) {
    const LightTransport transport = see(white_noise_surface(24, 16, 0.1), patches);
    BounceOptions stored;
    stored.bounces = 6;
    const Bounces at_one = bounce_light(transport, stored);
    for (const int count : {0, 1, 2, 6}) {
      const AlbedoLight light = bounce_with_albedo(transport, everywhere(transport, 0.5f), bounces(count));
      for (size_t i = 0; i < light.texel_light.size(); ++i) {
        double sum = 0;
        for (int b = 0; b <= count; ++b)
          sum += std::ldexp(static_cast<double>(at_one.irradiance[static_cast<size_t>(b)][i]), -b);
        // Planes are floats.
        ASSERT_NEAR(light.texel_light[i], sum / 3.14159265358979, 2e-7) << count;
      }
    }
  }
}

TEST(AlbedoLight, ConvergedIsWhereAnotherBounceChangesNothing) {
  const LightTransport transport = see(white_noise_surface(24, 24, 0.1), PatchKind::kFacets);
  std::vector<float> albedo(transport.bounce_matrix().rows);
  for (size_t i = 0; i < albedo.size(); ++i) albedo[i] = static_cast<float>(i % 10) / 9;
  AlbedoOptions options;
  options.tolerance = 1e-9;
  const AlbedoLight light = bounce_with_albedo(transport, albedo, options);
  EXPECT_LE(light.missing, 1e-9);
  std::vector<double> reflected(albedo.size()), again(albedo.size());
  for (size_t i = 0; i < albedo.size(); ++i)
    reflected[i] = static_cast<double>(albedo[i]) * light.patch_light[i];
  multiply(transport.bounce_matrix(), reflected, again);
  // The product rounds the light, which is below 1, to float.
  for (size_t i = 0; i < albedo.size(); ++i)
    ASSERT_NEAR(static_cast<double>(transport.patch_direct()[i]) + again[i], light.patch_light[i],
                0x1p-25 + 2e-9);
}

TEST(AlbedoLight, BlackReflectsNothing) {
  const LightTransport transport = see(white_noise_surface(16, 16, 0.1), PatchKind::kFacets);
  const AlbedoLight light = bounce_with_albedo(transport, everywhere(transport, 0), {});
  EXPECT_EQ(light.missing, 0);
  for (size_t i = 0; i < light.texel_light.size(); ++i)
    ASSERT_EQ(light.texel_light[i], static_cast<double>(transport.direct_over_pi[i]));
}

TEST(AlbedoLight, WrongSizesAndAlbedosAreABug) {
  const LightTransport transport = see(white_noise_surface(8, 8, 0.1), PatchKind::kFacets);
  EXPECT_THROW(bounce_with_albedo(transport, std::vector<float>(7), {}), std::logic_error);
  EXPECT_THROW(bounce_with_albedo(transport, everywhere(transport, 1.5f), {}), std::logic_error);
  EXPECT_THROW(bounce_with_albedo(transport, everywhere(transport, std::nanf("")), {}), std::logic_error);
}

}  // namespace
}  // namespace hemibake
