// Ground beyond the border (--edge ground): closed forms, the independent horizon program, energy, the judge.
#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "core/statistics.h"
#include "reference/path_tracer.h"
#include "support/brute_horizon.h"
#include "support/maps.h"
#include "support/rows.h"
#include "tracers/embree/embree.h"
#include "tracers/slice/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

std::unique_ptr<Tracer> slices(const Surface& surface, int azimuths, PatchKind patches = PatchKind::kFacets) {
  SliceOptions options;
  options.azimuths = azimuths;
  options.patch_kind = patches;
  return make_slice_tracer(surface, options);
}

std::unique_ptr<Tracer> rays(const Surface& surface, int count, PatchKind patches = PatchKind::kFacets) {
  RayOptions options;
  options.rays = count;
  options.patch_kind = patches;
  return make_embree_tracer(surface, options);
}

// A plane that rises by `slope` along x.
Surface plane(int width, int height, double slope, Edge edge = Edge::kGround) {
  Grid<float> heights(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) heights(x, y) = static_cast<float>(x);
  return make_surface(std::move(heights), std::max(width, height), slope, edge);
}

TEST(Ground, PlaneOf45DegreesSeesTheSkyAboveTheHorizontal) {
  const Surface surface = plane(24, 17, 1);
  // Of the directions a lune of 135° is sky; of the cosine (1 + cos 45°)/2 = .8536.
  const double uniform = 0.75, cosine = (1 + std::cos(kPi / 4)) / 2;
  const auto by_slices = slices(surface, 512), by_rays = rays(surface, 4096);
  for (uint32_t texel = 0; texel < surface.texel_count(); texel += 5) {
    const Row exact = texel_row(*by_slices, texel), sampled = texel_row(*by_rays, texel);
    EXPECT_NEAR(exact.visible_fraction, uniform, 2e-5);
    EXPECT_NEAR(exact.direct_over_pi, cosine, 2e-5);
    EXPECT_NEAR(sampled.visible_fraction, uniform, 2 * std::pow(4096, -0.75));
    EXPECT_NEAR(sampled.direct_over_pi, cosine, 2 * std::pow(4096, -0.75));
    // The sky's mean direction lies in the plane of the slope, between the normal and the zenith.
    EXPECT_NEAR(exact.bent_normal.y, 0, 1e-4);
    EXPECT_GT(exact.bent_normal.x / exact.bent_normal.z, -1);
    EXPECT_LT(exact.bent_normal.x, 0);
  }
}

TEST(Ground, PlanesOfEverySlopeHaveTheirClosedForm) {
  for (const double slope : {0.01, 0.3, 3.0, 50.0}) {
    const double tilt = std::atan(slope);
    const Row row = texel_row(*slices(plane(9, 9, slope), 1024), 40);
    EXPECT_NEAR(row.visible_fraction, 1 - tilt / kPi, 1e-4) << slope;
    EXPECT_NEAR(row.direct_over_pi, (1 + std::cos(tilt)) / 2, 1e-4) << slope;
  }
}

// A receiver that sees nothing but sky and ground beyond links to itself: E/π = V / (1 − ρ (1 − V)).
TEST(Ground, PlaneIsLitByGroundThatLooksAsItself) {
  const Surface surface = plane(12, 9, 1);
  const double visibility = (1 + std::cos(kPi / 4)) / 2, albedo = 0.9;
  for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels})
    for (const auto& tracer : {slices(surface, 256, patches), rays(surface, 4096, patches)}) {
      BounceOptions options;
      options.bounces = 3;
      options.converge_tolerance = 1e-6;
      options.max_bounces = 200;
      options.bounce_albedo = albedo;
      const Bounces bounces = bounce_light(trace_surface(*tracer, KeptLinks::kAll), options);
      for (size_t i = 0; i < surface.texel_count(); ++i) {
        EXPECT_NEAR(bounces.total[i], kPi, 1e-5 * kPi);
        // Nodes have fewer rays: 0.01 of V.
        EXPECT_NEAR(bounces.at_albedo[i], visibility / (1 - albedo * (1 - visibility)), 5e-3);
        EXPECT_NEAR(bounces.irradiance[1][i], kPi * visibility * (1 - visibility), 0.04);
      }
    }
}

TEST(Ground, EnergySumsToPi) {
  for (const auto kind : {SyntheticKind::kTerrain, SyntheticKind::kDunes, SyntheticKind::kConcrete}) {
    const Surface surface = synthetic_surface(kind, 40, 32, 0.3, {}, Edge::kGround);
    for (const auto& tracer : {slices(surface, 32), rays(surface, 128)}) {
      BounceOptions options;
      options.bounces = 5;
      options.converge_tolerance = 1e-6;
      const Bounces bounces = bounce_light(trace_surface(*tracer, KeptLinks::kAll), options);
      for (const float total : bounces.total.values) EXPECT_NEAR(total, kPi, 2e-5 * kPi);
    }
  }
}

// Receivers that see no border below the horizontal are as on an open map; all others see less sky.
TEST(Ground, NeverAddsSky) {
  const Surface ground = synthetic_surface(SyntheticKind::kTerrain, 64, 48, {}, {}, Edge::kGround);
  Surface open = ground;
  open.edge = Edge::kOpen;
  const auto of_ground = slices(ground, 64), of_open = slices(open, 64);
  int less = 0;
  for (uint32_t texel = 0; texel < ground.texel_count(); ++texel) {
    const Row below = texel_row(*of_ground, texel, false), above = texel_row(*of_open, texel, false);
    EXPECT_LE(below.visible_fraction, above.visible_fraction + 1e-4);
    EXPECT_LE(below.direct_over_pi, above.direct_over_pi + 1e-4);
    less += below.visible_fraction < above.visible_fraction - 1e-3;
  }
  EXPECT_GT(less, 100);
}

TEST(Ground, ReplayIsTheSkyOfTheRow) {
  const Surface surface = synthetic_surface(SyntheticKind::kTerrain, 32, 32, 0.3, {}, Edge::kGround);
  for (const auto& tracer : {slices(surface, 32), rays(surface, 256)})
    for (const uint32_t texel : {0u, 31u, 500u, 1023u}) {
      const Row row = texel_row(*tracer, texel);
      double uniform = 0, direct = 0, hit = 0;
      for (const RayRecord& record : tracer->replay_texel(texel)) {
        (record.hit ? hit : direct) += record.cosine_weight;
        if (!record.hit) uniform += record.uniform_weight;
      }
      EXPECT_NEAR(uniform, row.visible_fraction, 1e-4);
      EXPECT_NEAR(direct, row.direct_over_pi, 1e-4);
      EXPECT_LE(direct + hit, 1 + 1e-4);
    }
}

// The bar: bias 10⁻⁴ at most, rms .001 at most.
void expect_brute_force(SyntheticKind kind, int side, std::optional<double> amplitude_m, uint32_t stride) {
  const Surface surface = synthetic_surface(kind, side, side, amplitude_m, {}, Edge::kGround);
  const auto tracer = slices(surface, 512);
  std::vector<double> cosine, uniform;
  for (uint32_t texel = 0; texel < surface.texel_count(); texel += stride) {
    const Row row = texel_row(*tracer, texel, false);
    const BruteSky sky =
        brute_sky(surface, static_cast<int>(texel) % side, static_cast<int>(texel) / side, 360);
    cosine.push_back(row.direct_over_pi - sky.cosine);
    uniform.push_back(row.visible_fraction - sky.uniform);
  }
  for (const std::vector<double>& difference : {cosine, uniform}) {
    double squares = 0;
    for (const double d : difference) squares += d * d;
    const double rms = std::sqrt(squares / static_cast<double>(difference.size()));
    EXPECT_LE(std::abs(mean(difference)), 1e-4) << "rms " << rms;
    EXPECT_LE(rms, 1e-3) << "bias " << mean(difference);
  }
}

TEST(Ground, SkyViewFactorIsThatOfTheIndependentProgram) {
  expect_brute_force(SyntheticKind::kTerrain, 64, {}, 23);
  expect_brute_force(SyntheticKind::kTerrain, 64, 1.0, 23);
  expect_brute_force(SyntheticKind::kDunes, 64, {}, 23);
  expect_brute_force(SyntheticKind::kTerrain, 128, {}, 307);
}

// The judge takes the same light of the ground: first bounces agree within its interval.
TEST(Ground, BouncesAgreeWithTheReferencePathTracer) {
  const Surface surface = synthetic_surface(SyntheticKind::kTerrain, 32, 32, 0.3, {}, Edge::kGround);
  BounceOptions options;
  options.bounces = 3;
  const Bounces bounces = bounce_light(trace_surface(*slices(surface, 128), KeptLinks::kAll), options);
  std::vector<uint32_t> texels;
  for (uint32_t texel = 0; texel < surface.texel_count(); texel += 3) texels.push_back(texel);
  RefereeOptions judging;
  judging.paths = 1024;
  judging.bounces = 2;
  judging.totals.clear();
  const RefereeEstimates judged = referee_texels(surface, texels, judging);
  for (int b = 0; b <= 2; ++b) {
    double bias = 0, variance = 0, mean_light = 0;
    for (size_t i = 0; i < texels.size(); ++i) {
      const double light = static_cast<double>(bounces.irradiance[static_cast<size_t>(b)][texels[i]]) / kPi;
      bias += light - judged.mean[judged.index(i, b)];
      variance += judged.variance[judged.index(i, b)];
      mean_light += light;
    }
    const double count = static_cast<double>(texels.size());
    // Four standard errors, and 1 % for the patches (src/reference/README.md: 0.4 % of E1).
    EXPECT_NEAR(bias / count, 0, 4 * std::sqrt(variance) / count + 0.01 * mean_light / count)
        << "bounce " << b;
  }
}

}  // namespace
}  // namespace hemibake
