#include "estimators/horizon.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "support/maps.h"
#include "surface/synthetic/analytic.h"
#include "tracers/slice/slice.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

HorizonOptions fine(AoKind kind, double radius_m, int azimuths, int steps) {
  HorizonOptions options;
  options.azimuths = azimuths;
  options.steps = steps;
  options.radius_m = radius_m;
  options.step_power = 1;
  options.kind = kind;
  options.jitter = false;
  return options;
}

TEST(Horizon, FlatGroundIsOpen) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen, Edge::kGround}) {
    const Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8, 0.1, {}, edge);
    for (const AoKind kind : {AoKind::kUniform, AoKind::kCosine}) {
      HorizonOptions options;
      options.kind = kind;
      options.radius_m = 0.5;
      for (const float ao : estimate_horizon(surface, options).ao.values) ASSERT_NEAR(ao, 1, 1e-6);
    }
  }
}

// A hemisphere tilted by t over flat ground: 1 − t/π of its directions and (1 + cos t)/2 of its cosine are
// sky.
TEST(Horizon, TiltedNormalsLoseWhatLiesBelow) {
  const double tilt = 0.7;
  Surface surface = synthetic_surface(SyntheticKind::kFlat, 4, 4);
  for (glm::vec3& normal : surface.normals.values) normal = glm::vec3(std::sin(tilt), 0, std::cos(tilt));
  // Smooth and periodic in the azimuth but for a kink: the midpoint error falls like azimuths⁻².
  EXPECT_NEAR(estimate_horizon(surface, fine(AoKind::kUniform, 1, 256, 4)).ao[0], 1 - tilt / kPi, 1e-4);
  EXPECT_NEAR(estimate_horizon(surface, fine(AoKind::kCosine, 1, 256, 4)).ao[0], (1 + std::cos(tilt)) / 2,
              1e-4);
}

// Returns the worst error over the floor's or wall's texels against the closed form.
double canyon_error(int azimuths, int steps, AoKind kind) {
  const Surface surface = synthetic_surface(SyntheticKind::kCanyon, 64, 1, 16.0 / 64);
  const WallGeometry walls = canyon_geometry(64);
  // Far enough that only directions within 16/512 of the horizon's height along the canyon are missed.
  const Estimate estimate = estimate_horizon(surface, fine(kind, 512.0 / 64, azimuths, steps));
  double worst = 0;
  for (int x = walls.left_edge + 2; x < walls.right_edge - 1; ++x) {
    const double a = std::atan(16.0 / (x - walls.left_edge)), b = std::atan(16.0 / (walls.right_edge - x));
    const double truth = kind == AoKind::kUniform ? 1 - (a + b) / kPi : (std::cos(a) + std::cos(b)) / 2;
    worst = std::max(worst, std::abs(static_cast<double>(estimate.ao(x, 0)) - truth));
  }
  return worst;
}

double groove_error(int azimuths, int steps, AoKind kind, double angle) {
  const Surface surface = synthetic_surface(SyntheticKind::kGroove, 64, 1, {}, angle);
  const GrooveGeometry groove = groove_geometry(64, angle);
  const Estimate estimate = estimate_horizon(surface, fine(kind, 256.0 / 64, azimuths, steps));
  double worst = 0;
  for (int x = 1; x < groove.wall_width; ++x) {
    const double s = x / std::sin(angle), l = groove.wall_width / std::sin(angle);
    const double f =
        (l * std::cos(2 * angle) - s) / std::sqrt(l * l + s * s - 2 * l * s * std::cos(2 * angle));
    const double truth = kind == AoKind::kUniform ? std::acos(f) / kPi : (1 - f) / 2;
    worst = std::max(worst, std::abs(static_cast<double>(estimate.ao(x, 0)) - truth));
  }
  return worst;
}

TEST(Horizon, ConvergesOnTheCanyon) {
  for (const AoKind kind : {AoKind::kUniform, AoKind::kCosine}) {
    const double coarse = canyon_error(8, 64, kind), middle = canyon_error(32, 512, kind),
                 close = canyon_error(128, 4096, kind);
    std::printf("canyon, %s: worst error %.4f, %.4f, %.4f\n", kind == AoKind::kUniform ? "uniform" : "cosine",
                coarse, middle, close);
    EXPECT_LT(middle, coarse);
    EXPECT_LT(close, middle);
    EXPECT_LT(close, 0.005);
  }
}

TEST(Horizon, ConvergesOnTheGroove) {
  for (const AoKind kind : {AoKind::kUniform, AoKind::kCosine})
    for (const double angle : {kPi / 4, kPi / 6}) {
      const double coarse = groove_error(8, 32, kind, angle), middle = groove_error(32, 256, kind, angle),
                   close = groove_error(128, 2048, kind, angle);
      std::printf("groove %.0f deg, %s: worst error %.4f, %.4f, %.4f\n", angle * 180 / kPi,
                  kind == AoKind::kUniform ? "uniform" : "cosine", coarse, middle, close);
      EXPECT_LT(close, middle);
      EXPECT_LT(close, 0.005);
    }
}

// A shader that has V has α for two cosines a slice: one search of the horizons gives both.
TEST(Horizon, BothKindsComeFromOneSearch) {
  const Surface surface = white_noise_surface(16, 16, 3);
  HorizonOptions options;
  options.kind = AoKind::kCosine;
  const Estimate of_visibility = estimate_horizon(surface, options);
  options.kind = AoKind::kUniform;
  const Estimate of_ao = estimate_horizon(surface, options);
  EXPECT_EQ(of_visibility.ao.values, of_ao.other_ao.values);
  EXPECT_EQ(of_visibility.other_ao.values, of_ao.ao.values);
}

// With many azimuths and steps both are the tracer's, which takes the horizon of every triangle. What
// remains: samples that jump over a crest, here 12 steps a texel, and what lies beyond the radius.
TEST(Horizon, VisibilityAndAoConvergeToTheTracer) {
  for (const SyntheticKind kind : {SyntheticKind::kNoise, SyntheticKind::kBricks, SyntheticKind::kConcrete}) {
    const Surface surface = synthetic_surface(kind, 32, 32);
    SliceOptions slices;
    slices.azimuths = 256;
    const LightTransport truth = trace_surface(*make_slice_tracer(surface, slices), KeptLinks::kAll);
    const double radius_m = 3;
    const Estimate estimate = estimate_horizon(surface, fine(AoKind::kCosine, radius_m, 256, 12 * 96));
    double worst_ao = 0, worst_visibility = 0;
    for (size_t i = 0; i < estimate.ao.size(); ++i) {
      const double ao = static_cast<double>(truth.visible_fraction[i]);
      const double visibility = static_cast<double>(truth.direct_over_pi[i]);
      worst_ao = std::max(worst_ao, std::abs(static_cast<double>(estimate.other_ao[i]) - ao));
      worst_visibility =
          std::max(worst_visibility, std::abs(static_cast<double>(estimate.ao[i]) - visibility));
    }
    std::printf("horizon against the tracer: largest difference of V %.4f, of ao %.4f\n", worst_visibility,
                worst_ao);
    EXPECT_LT(worst_ao, 0.01);
    EXPECT_LT(worst_visibility, 0.01);
  }
}

TEST(Horizon, BentNormalLooksAlongTheMiddleOfTheSky) {
  const Surface surface = synthetic_surface(SyntheticKind::kStep, 32, 32, 0.25, {}, Edge::kOpen);
  const int x = step_geometry(32).left_edge + 2;
  const Estimate estimate = estimate_horizon(surface, fine(AoKind::kCosine, 1, 32, 128));
  // Beside a high wall nearly a quarter of the sphere is left: its mean direction lies near 45°.
  EXPECT_NEAR(estimate.bent_normals(x, 16).x, std::sqrt(0.5), 0.15);
  EXPECT_NEAR(estimate.bent_normals(x, 16).y, 0, 0.05);
  EXPECT_GT(estimate.bent_normals(x, 16).z, 0.6f);
}

}  // namespace
}  // namespace hemibake
