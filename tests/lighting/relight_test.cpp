#include "lighting/relight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "lighting/shaded_scene.h"
#include "support/maps.h"
#include "tracers/embree/embree.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

// Two texels that are patches and see each other and the sky.
LightTransport two_patches(double to_second, double to_first) {
  LightTransport transport;
  transport.direct_over_pi = Grid<float>(2, 1);
  transport.direct_over_pi[0] = static_cast<float>(1 - to_second);
  transport.direct_over_pi[1] = static_cast<float>(1 - to_first);
  transport.final_gather = make_form_factors(2, 2);
  const FormFactor first{1, static_cast<float>(to_second)}, second{0, static_cast<float>(to_first)};
  append_row(transport.final_gather.blocks[0], {&first, 1});
  append_row(transport.final_gather.blocks[0], {&second, 1});
  finish_blocks(transport.final_gather);
  return transport;
}

// E₁ = e₁ + w₁₂ ρ₂ E₂ and E₂ = e₂ + w₂₁ ρ₁ E₁, each with its neighbour's albedo.
TEST(Relight, TwoPatchesWithTheirOwnAlbedo) {
  const LightTransport transport = two_patches(0.75, 0.5);
  const ColoredLight direct{{glm::dvec3(1, 2, 0), glm::dvec3(3, 0, 0)},
                            {glm::dvec3(1, 2, 0), glm::dvec3(3, 0, 0)}};
  const std::vector<glm::vec3> albedo = {{0.5f, 0.25f, 1}, {0.25f, 1, 1}};
  const Relit relit = relight_by_transport(transport, direct, albedo, 60);
  for (int c = 0; c < 3; ++c) {
    const double a = 0.75 * static_cast<double>(albedo[1][c]), b = 0.5 * static_cast<double>(albedo[0][c]);
    const double e1 = direct.texel_light[0][c], e2 = direct.texel_light[1][c];
    EXPECT_NEAR(relit.total[0][c], (e1 + a * e2) / (1 - a * b), 1e-6) << c;
    EXPECT_NEAR(relit.total[1][c], (e2 + b * e1) / (1 - a * b), 1e-6) << c;
  }
  EXPECT_FLOAT_EQ(relit.bounces[1][0].x, 0.75f * 0.25f * 3);
}

class RelightBricks : public testing::Test {
 protected:
  static const Surface& surface() {
    static const Surface map = synthetic_surface(SyntheticKind::kBricks, 24, 20, 0.1);
    return map;
  }
  static const LightTransport& transport() {
    static const LightTransport traced = [] {
      RayOptions options;
      options.rays = 64;
      const auto tracer = make_embree_tracer(surface(), options);
      return trace_surface(*tracer, KeptLinks::kAll);
    }();
    return traced;
  }
  static ColoredLight uniform_light() {
    ColoredLight light;
    for (const float direct : transport().direct_over_pi.values)
      light.texel_light.emplace_back(kPi * static_cast<double>(direct));
    for (const float direct : transport().patch_direct())
      light.patch_light.emplace_back(kPi * static_cast<double>(direct));
    return light;
  }
};

// The bar: a map of one value against ρᵇ E_b. Bounces are stored as floats, and every product rounds to float
// what it multiplies: 2⁻²⁴ of each; below the smallest normal one they are 0.
TEST_F(RelightBricks, ConstantMapIsPowersOfAlbedo) {
  const glm::vec3 albedo(0.9f, 0.6f, 0);
  const Relit powers = relight_constant(bounce_light(transport(), {}).irradiance, albedo);
  const Albedo map{glm::vec3(0), Grid<glm::vec3>(24, 20, albedo)};
  const Relit over_links = relight_by_transport(
      transport(), uniform_light(),
      albedo_of_patches(surface(), map, make_patches(surface(), PatchKind::kFacets)), 20, kPi);
  ASSERT_EQ(powers.bounces.size(), over_links.bounces.size());
  for (size_t b = 0; b < powers.bounces.size(); ++b)
    for (size_t i = 0; i < powers.total.size(); ++i)
      for (int c = 0; c < 3; ++c)
        ASSERT_NEAR(over_links.bounces[b][i][c], powers.bounces[b][i][c],
                    (4 + static_cast<float>(b)) * 0x1p-24f * powers.bounces[b][i][c] +
                        std::numeric_limits<float>::min())
            << b << ' ' << i;
  // The rest after bounce 20 doubles as much of the last two as 1/(1−q)² is: q is below 0.9 here.
  for (size_t i = 0; i < powers.total.size(); ++i)
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(over_links.total[i][c], powers.total[i][c], 2e-6);
}

TEST_F(RelightBricks, BlackWallReflectsNothing) {
  const Relit relit =
      relight_by_transport(transport(), uniform_light(),
                           std::vector<glm::vec3>(transport().final_gather.columns, glm::vec3(0)), 3);
  for (size_t i = 0; i < relit.total.size(); ++i) EXPECT_EQ(relit.total[i], relit.bounces[0][i]);
  EXPECT_EQ(relit.largest_rest, 0);
}

// At albedo 1 all light comes out: π in every texel, whatever the map; the series knows the rest after 20
// bounces.
TEST_F(RelightBricks, WhiteWallGivesPi) {
  const Relit relit = relight_constant(bounce_light(transport(), {}).irradiance, glm::vec3(1));
  double mean = 0;
  for (const glm::vec3& total : relit.total.values) {
    EXPECT_LE(total.x, static_cast<float>(kPi) * (1 + 1e-6f));
    mean += static_cast<double>(total.x) / kPi / static_cast<double>(relit.total.size());
  }
  EXPECT_GT(relit.mean_rest, 0);
  // Without the rest the mean falls short by mean_rest; with it, by what is not one series: a tenth of that.
  EXPECT_NEAR(mean, 1, 0.1 * relit.mean_rest / kPi + 1e-6);
}

// E_b = a qᵇ has the sum a/(1−ρq): a V-groove's vertex, the spherical pit.
TEST(Relight, RestOfASeriesIsExact) {
  std::vector<Grid<float>> irradiance;
  const double a = 0.2, q = 0.9;
  for (int b = 0; b <= 5; ++b) irradiance.emplace_back(1, 1, static_cast<float>(a * std::pow(q, b)));
  const Relit relit = relight_constant(irradiance, glm::vec3(0.9f, 0.5f, 0));
  EXPECT_NEAR(relit.total[0].x, a / (1 - 0.9 * q), 5e-6);  // ratio to 2⁻²³, over (1 − 0.81)²
  EXPECT_NEAR(relit.total[0].y, a / (1 - 0.5 * q), 1e-6);
  EXPECT_FLOAT_EQ(relit.total[0].z, static_cast<float>(a));
  // Light that still seeps in: no bounce sends on more than the albedo.
  const std::vector<Grid<float>> rising = {Grid<float>(1, 1, 0.1f), Grid<float>(1, 1, 0.2f),
                                           Grid<float>(1, 1, 0.4f)};
  EXPECT_NEAR(relight_constant(rising, glm::vec3(0.5f)).largest_rest, 0.25 * 0.4, 1e-6);
  irradiance.resize(1);
  EXPECT_EQ(relight_constant(irradiance, glm::vec3(1)).largest_rest, 0) << "one bounce is no series";
}

TEST(Relight, PatchesHaveTheAlbedoBetweenTheTexels) {
  const Surface surface = make_surface(Grid<float>(3, 3), 1, 0, Edge::kWrap);
  Albedo albedo;
  albedo.map = Grid<glm::vec3>(3, 3);
  albedo.map(2, 2) = glm::vec3(0.9f, 0.3f, 0);
  // A tent of height 1 over texel 2,2: linear over the ground, 1 − the distance along x, y or the diagonal.
  const PatchSet nodes = make_patches(surface, PatchKind::kFacets);
  const auto values = albedo_of_patches(surface, albedo, nodes);
  for (uint32_t patch = 0; patch < nodes.count; ++patch) {
    const glm::dvec2 at = patch_position_texels(surface, nodes, patch) - 2.0;
    const double x = at.x < -1.5 ? at.x + 3 : at.x, y = at.y < -1.5 ? at.y + 3 : at.y;
    const double tent = std::max(0.0, 1 - std::max({std::abs(x), std::abs(y), std::abs(x + y)}));
    EXPECT_NEAR(values[patch].x, 0.9 * tent, 1e-6) << at.x << ' ' << at.y;
    EXPECT_NEAR(values[patch].y, 0.3 * tent, 1e-6);
  }
  EXPECT_EQ(albedo_of_patches(surface, albedo, make_patches(surface, PatchKind::kTexels))[8].x, 0.9f);
}

// AO darkens the sky's light only: a sun adds the same to every picture.
TEST(ShadedScene, NoAoDarkensTheSun) {
  ShadedScene scene;
  scene.bake.width = 3;
  scene.bake.height = 1;
  scene.bake.visible_fraction = Grid<float>(3, 1);
  for (size_t i = 0; i < 3; ++i) scene.bake.visible_fraction[i] = 0.5f * static_cast<float>(i);
  scene.albedo.constant = {0.5f, 0.25f, 1};
  scene.sky = Grid<glm::vec3>(3, 1, glm::vec3(2));
  const auto half = [](const TexelInputs& at, double albedo) { return at.ao * albedo; };
  const Grid<glm::vec3> ao_before = shade_ao_only(scene), model_before = shade_with(scene, half);
  scene.sun = Grid<glm::vec3>(3, 1, glm::vec3(4));
  const Grid<glm::vec3> ao_after = shade_ao_only(scene), model_after = shade_with(scene, half);
  for (size_t i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) {
      const double sun = static_cast<double>(scene.albedo.constant[c]) * 4 / kPi;
      EXPECT_NEAR(ao_after[i][c] - ao_before[i][c], sun, 2e-7);
      EXPECT_NEAR(model_after[i][c] - model_before[i][c], sun, 2e-7);
    }
  EXPECT_EQ(ao_before[0].x, 0);
}

}  // namespace
}  // namespace hemibake
