#include "transport/bounces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "support/maps.h"
#include "support/threads.h"
#include "surface/facets.h"
#include "tracers/embree/embree.h"

namespace hemibake {
namespace {

// Two texels that see each other: E₀/π = c, the rest goes to the other.
LightTransport two_texels(float c) {
  LightTransport transport;
  transport.visible_fraction = Grid<float>(2, 1, c);
  transport.direct_over_pi = Grid<float>(2, 1, c);
  transport.final_gather = make_form_factors(2, 2);
  for (uint32_t i = 0; i < 2; ++i)
    append_row(transport.final_gather.blocks[0], std::vector<FormFactor>{{1 - i, 1 - c}});
  finish_blocks(transport.final_gather);
  return transport;
}

TEST(Bounces, TwoTexelsAreAGeometricSeries) {
  const Bounces bounces = bounce_light(two_texels(0.25f), {});
  ASSERT_EQ(bounces.irradiance.size(), 21u);
  for (int b = 0; b <= 20; ++b)
    EXPECT_NEAR(bounces.irradiance[static_cast<size_t>(b)][0], kPi * 0.25 * std::pow(0.75, b), 1e-6);
  EXPECT_NEAR(bounces.worst_residual, std::pow(0.75, 21), 1e-9);
  EXPECT_NEAR(bounces.total[1], kPi * (1 - std::pow(0.75, 21)), 1e-6);
}

TEST(Bounces, ConvergenceGoesOnUntilTheToleranceAndNoFurther) {
  BounceOptions options;
  options.bounces = 3;
  options.converge_tolerance = 1e-6;
  const Bounces bounces = bounce_light(two_texels(0.25f), options);
  EXPECT_EQ(bounces.irradiance.size(), 4u);
  for (const float residual : bounces.residual.values) EXPECT_LT(std::abs(residual), 1e-6f);
  EXPECT_LE(bounces.bounces_made,
            3 + 4);  // two texels that are alike have one way to go; plain bounces take 48
  EXPECT_TRUE(bounces.unconverged_texels.empty());
}

TEST(Bounces, TheCapEndsItAndNamesWhatIsShort) {
  LightTransport transport = two_texels(0.25f);
  transport.direct_over_pi[1] = 0;
  transport.final_gather = make_form_factors(2, 2);
  append_row(transport.final_gather.blocks[0], std::vector<FormFactor>{{1, 0.75f}});
  append_row(transport.final_gather.blocks[0], std::vector<FormFactor>{{1, 1.0f}});  // sees only itself
  finish_blocks(transport.final_gather);
  BounceOptions options;
  options.converge_tolerance = 1e-6;
  options.max_bounces = 50;
  const Bounces bounces = bounce_light(transport, options);
  EXPECT_LE(bounces.bounces_made, 50);
  EXPECT_EQ(bounces.unconverged_texels, (std::vector<uint32_t>{0, 1}));
  EXPECT_EQ(bounces.enclosed_texels, (std::vector<uint32_t>{1}));
  EXPECT_NEAR(bounces.residual[1], 1, 1e-6);
}

TEST(Bounces, NoBouncesLeavesTheDirectLight) {
  BounceOptions options;
  options.bounces = 0;
  const Bounces bounces = bounce_light(two_texels(0.25f), options);
  ASSERT_EQ(bounces.irradiance.size(), 1u);
  EXPECT_NEAR(bounces.total[0], kPi * 0.25, 1e-6);
  EXPECT_NEAR(bounces.residual[0], 0.75, 1e-6);
}

LightTransport see(const Surface& surface, PatchKind patches, int rays, uint64_t seed = 0) {
  RayOptions options;
  options.seed = seed;
  options.rays = rays;
  options.patch_kind = patches;
  return trace_surface(*make_embree_tracer(surface, options), KeptLinks::kAll);
}

// At albedo 1 all light comes back out: π in every texel, whatever the map.
TEST(Bounces, EnergyIsPiInEveryTexel) {
  BounceOptions options;
  options.converge_tolerance = 1e-5;
  const Surface maps[] = {
      synthetic_surface(SyntheticKind::kNoise, 64, 64, 0.2), white_noise_surface(48, 48, 0.05),
      synthetic_surface(SyntheticKind::kGroove, 32, 16), synthetic_surface(SyntheticKind::kFlat, 8, 8)};
  for (const Surface& surface : maps) {
    const Bounces bounces = bounce_light(see(surface, PatchKind::kFacets, 256), options);
    EXPECT_TRUE(bounces.unconverged_texels.empty());
    for (const float total : bounces.total.values) ASSERT_NEAR(static_cast<double>(total) / kPi, 1, 2e-5);
  }
  for (const SyntheticKind kind : {SyntheticKind::kGroove, SyntheticKind::kFlat}) {
    const Bounces bounces =
        bounce_light(see(synthetic_surface(kind, 32, 16), PatchKind::kTexels, 256), options);
    for (const float total : bounces.total.values) ASSERT_NEAR(static_cast<double>(total) / kPi, 1, 2e-5);
  }
}

// Mean over the facets' area of the product of what is linear between nodes, exactly: the rule of the middles
// of the sides of all triangles between nodes, where the two nodes at the ends of a side share alike.
double mean_product(const Surface& surface, const PatchSet& patches, const std::vector<double>& f,
                    const std::vector<double>& g) {
  double sum = 0, area_sum = 0;
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
    const int k = facet_node(patches, sample_patch(patches, facet, {0, 0}, 0)).subdivision;
    const double area = facet_area_ratio(surface, facet);
    area_sum += area;
    for (int b = 0; b <= 2 * k; ++b)
      for (int a = 0; a + b <= 2 * k; ++a) {
        if (a % 2 == 0 && b % 2 == 0) continue;  // a node
        const bool on_border = a == 0 || b == 0 || a + b == 2 * k;
        const glm::dvec2 middle = glm::dvec2(a, b) / (2.0 * k);
        const uint32_t one = sample_patch(patches, facet, middle, 0.25),
                       other = sample_patch(patches, facet, middle, 0.75);
        sum += area * (on_border ? 1 : 2) / (3.0 * k * k) * (f[one] + f[other]) / 2 * (g[one] + g[other]) / 2;
      }
  }
  return sum / area_sum;
}

// Mean E_{b+1} = mean E_b (1 − E₀/π) over the area of a tiled map: what hits the surface again is what did
// not escape (reciprocity, which nodes know only to the accuracy of linear light between them: up to 0.6 % a
// bounce on this map, whose slopes turn by as much as 10° from texel to texel).
TEST(Bounces, LightThatStaysIsLightThatComesBack) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 64, 64, 0.2);
  const LightTransport transport = see(surface, PatchKind::kFacets, 256);
  // Of other rays, so that the noise of a node is not multiplied by itself.
  const LightTransport again = see(surface, PatchKind::kFacets, 256, 1);
  const PatchSet patches = make_patches(surface, PatchKind::kFacets);
  std::vector<double> light(transport.patch_direct_over_pi.begin(), transport.patch_direct_over_pi.end()),
      next(light.size());
  std::vector<double> ones(light.size(), 1), blocked(light.size());
  for (size_t i = 0; i < light.size(); ++i)
    blocked[i] = 1 - static_cast<double>(again.patch_direct_over_pi[i]);
  for (int bounce = 0; bounce < 4; ++bounce) {
    multiply(transport.patch_form_factors, light, next);
    EXPECT_NEAR(mean_product(surface, patches, next, ones) / mean_product(surface, patches, light, blocked),
                1, 1e-2);
    light = next;
  }
}

TEST(Bounces, SameBytesAtAnyThreadCount) {
  const Surface surface = white_noise_surface(80, 64, 0.1);
  const auto run = [&](int threads) {
    set_thread_count(threads);
    const LightTransport transport = see(surface, PatchKind::kFacets, 64);
    return bounce_light(transport, {});
  };
  const Bounces one = run(1), two = run(2);
  set_thread_count(0);
  for (size_t b = 0; b < one.irradiance.size(); ++b)
    ASSERT_EQ(one.irradiance[b].values, two.irradiance[b].values);
  EXPECT_EQ(one.total.values, two.total.values);
}

}  // namespace
}  // namespace hemibake
