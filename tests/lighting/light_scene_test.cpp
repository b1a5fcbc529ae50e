#include "lighting/light_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/color.h"
#include "core/constants.h"
#include "core/error.h"
#include "support/maps.h"
#include "tracers/embree/embree.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

LightTransport traced(const Surface& surface, PatchKind patches) {
  RayOptions options;
  options.rays = 64;
  options.patch_kind = patches;
  return trace_surface(*make_embree_tracer(surface, options), KeptLinks::kAll);
}

TEST(LightScene, UniformSkyAtOneAlbedoIsTheWeightedSumOfTheBake) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 24, 20, 0.1);
  constexpr int kBounces = 20;
  for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels}) {
    const LightTransport transport = traced(surface, patches);
    const Albedo albedo{glm::vec3(0.5f, 0.25f, 0), {}};
    const LitScene lit = light_scene(surface, transport, albedo, {make_uniform_sky(), {}, 256}, kBounces);
    const Relit expected =
        relight_constant(bounce_light(transport, {kBounces, {}}).irradiance, albedo.constant);
    EXPECT_TRUE(lit.sun.empty());
    EXPECT_FALSE(lit.projection_error);
    // Light is rounded to float in every product, planes when they are stored: 2⁻²⁴ π · (2 · Σ b ρᵇ + 21), Σ
    // b ρᵇ ≤ 2.
    const double tolerance = 0x1p-24 * kPi * 25;
    for (size_t i = 0; i < lit.relit.total.size(); ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(lit.relit.total[i][c], expected.total[i][c], tolerance) << i << " " << c;
  }
}

TEST(LightScene, FlatGroundReceivesSkyAndSun) {
  const Surface surface = make_surface(Grid<float>(4, 4), 1, 1, Edge::kWrap);
  const LightTransport transport = traced(surface, PatchKind::kFacets);
  const Sun sun{direction_of(1, kPi / 6), 4};
  const Albedo albedo{glm::vec3(0.5f), {}};
  const LitScene lit = light_scene(surface, transport, albedo, {make_uniform_sky(), sun, 16}, 2);
  for (size_t i = 0; i < lit.sun.size(); ++i) {
    EXPECT_FLOAT_EQ(lit.sun[i].x, 2);  // sin 30° · 4
    EXPECT_FLOAT_EQ(lit.relit.total[i].y, static_cast<float>(kPi + 2));
  }
}

TEST(LightScene, ConstantSkyMapHasNoProjectionError) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 8, 8, 0.1);
  const LightTransport transport = traced(surface, PatchKind::kTexels);
  const Sky sky = make_lat_long_sky(Grid<glm::vec3>(64, 32, glm::vec3(2)));
  const LitScene lit = light_scene(surface, transport, {glm::vec3(0), {}}, {sky, {}, 64}, 0);
  ASSERT_TRUE(lit.projection_error);
  // The mean of the nine coefficients is exact; those of band 2 by the midpoints of 32 rows to (π/32)².
  EXPECT_LT(lit.projection_error->rms, 0.01);
  for (size_t i = 0; i < lit.relit.total.size(); ++i)
    EXPECT_NEAR(lit.relit.total[i].x, 2 * kPi * transport.direct_over_pi[i], 1e-5);
}

TEST(LightScene, NeedsTransportForAnyLightButTheBakes) {
  const Albedo constant{glm::vec3(0.5f), {}}, map{glm::vec3(0), Grid<glm::vec3>(2, 2)};
  const SceneLight uniform{make_uniform_sky(), {}, 1}, sunny{make_uniform_sky(), Sun{}, 1}, sky{Sky{}, {}, 1};
  EXPECT_FALSE(needs_transport(uniform, constant));
  EXPECT_TRUE(needs_transport(uniform, map));
  EXPECT_TRUE(needs_transport(sunny, constant));
  EXPECT_TRUE(needs_transport(sky, constant));
}

TEST(LightScene, UnshadedSkyIsPiUnderAUniformSkyAndFollowsNormalsElsewhere) {
  EXPECT_EQ(unshaded_sky(make_uniform_sky(), {}, 3, 2)[5].z, static_cast<float>(kPi));
  Sky sky;  // radiance 1 + z: π + 2π/3 n_z
  sky.harmonics[0] = glm::dvec3(std::sqrt(4 * kPi));
  sky.harmonics[2] = glm::dvec3(std::sqrt(4 * kPi / 3));
  const Grid<glm::vec3> irradiance = unshaded_sky(sky, Grid<glm::vec3>(1, 1, glm::vec3(0.6f, 0, 0.8f)), 1, 1);
  EXPECT_NEAR(irradiance[0].x, kPi + 2 * kPi / 3 * 0.8, 1e-6);
}

std::string refusal(Grid<glm::vec3> reflectance) {
  try {
    make_albedo_map(std::move(reflectance), AlbedoEncoding::kLinear);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(AlbedoMap, DecodesSrgbAndRefusesValuesOutOfRange) {
  Grid<glm::vec3> map(3, 2, glm::vec3(0.5f));
  EXPECT_EQ(make_albedo_map(map, AlbedoEncoding::kLinear).at(4).x, 0.5f);
  EXPECT_EQ(make_albedo_map(map, AlbedoEncoding::kSrgb).at(4).x, static_cast<float>(linear_from_srgb(0.5)));
  EXPECT_EQ(refusal(map), "");
  map(1, 1).y = 1.5f;
  EXPECT_EQ(refusal(map), "reflectance 1.5 at texel 1,1, expected 0..1");
  map(1, 1).y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_NE(refusal(map), "");
}

TEST(LatLongSky, RefusesNegativeRadiance) {
  Grid<glm::vec3> map(4, 2, glm::vec3(1));
  map(2, 1).z = -1;
  EXPECT_THROW(make_lat_long_sky(map), InputError);
}

}  // namespace
}  // namespace hemibake
