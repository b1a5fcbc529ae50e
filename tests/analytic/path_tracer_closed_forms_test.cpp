// Tests the reference path tracer where light has a closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "analytic/groove_reference.h"
#include "analytic/spherical_pit.h"
#include "core/constants.h"
#include "reference/path_tracer.h"
#include "reference/texel_sample.h"
#include "surface/synthetic/analytic.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {
namespace {

constexpr double kConfidence = 0.99;
constexpr double kWidestInterval = 0.005;  // relative
constexpr int kBounces = 5;

// A map of few texels: its walls are the exact groove at any resolution, and rays are short.
Surface make_groove(double psi) {
  SyntheticOptions options;
  options.width = 16;
  options.height = 16;
  options.angle_rad = psi;
  const SyntheticMap map = synthesize(SyntheticKind::kGroove, options);
  return make_surface(map.heights, 1, map.recommended_amplitude_m, Edge::kWrap);
}

void expect_holds(const RefereeInterval& interval, double truth, const std::string& quantity) {
  EXPECT_TRUE(interval.contains(truth))
      << quantity << ": " << interval.mean << " ± " << interval.half_width << ", expected " << truth;
  EXPECT_LE(interval.half_width, kWidestInterval * truth) << quantity;
}

void expect_groove(double psi, int paths) {
  RefereeOptions options;
  options.paths = paths;
  options.bounces = kBounces;
  const RefereeEstimates measured = referee_area(make_groove(psi), options);
  EXPECT_EQ(measured.truncated_rays, 0u);
  const std::vector<double> truth =
      groove_wall_means(psi, 40);  // after 40 the rest at albedo 0.5 is below 10⁻¹²
  double total = 0;
  for (size_t b = 0; b < truth.size(); ++b) total += truth[b] * std::pow(0.5, b);
  for (int b = 0; b <= kBounces; ++b)
    expect_holds(referee_interval(measured, 0, b, kConfidence), truth[static_cast<size_t>(b)],
                 fmt::format("E{}", b));
  expect_holds(referee_interval(measured, 0, kBounces + 1, kConfidence), total, "total");
}

TEST(GrooveReference, HasTheDigitsOfTwoQuadratures) {
  const double tolerance = 4e-6;  // of two integrals by trapezoids, see groove_reference.h
  const std::vector<double> at_45{.7071068, .1963495, .0629587, .0215180, .0076349};
  const std::vector<double> at_30{.5, .2267249, .1175442, .0646952, .0368762};
  const std::vector<double> mine_45 = groove_wall_means(kPi / 4, 4), mine_30 = groove_wall_means(kPi / 6, 4);
  for (size_t b = 0; b < 5; ++b) {
    EXPECT_NEAR(mine_45[b], at_45[b], tolerance);
    EXPECT_NEAR(mine_30[b], at_30[b], tolerance);
  }
}

TEST(PathTracerClosedForms, GrooveOf45Degrees) { expect_groove(kPi / 4, 3'800'000); }

TEST(PathTracerClosedForms, GrooveOf30Degrees) { expect_groove(kPi / 6, 2'500'000); }

TEST(PathTracerClosedForms, GrooveVertexAndWallTexels) {
  const double psi = kPi / 6;
  const Surface surface = make_groove(psi);
  const GrooveGeometry groove = groove_geometry(surface.width(), psi);
  RefereeOptions options;
  options.paths = 400'000;
  options.bounces = 3;
  const std::vector<uint32_t> texels{0, 1};  // on the vertex; halfway up a wall
  ASSERT_EQ(groove.wall_width, 2);
  const RefereeEstimates measured = referee_texels(surface, texels, options);
  // The truth lies outside one of five 99 % intervals in 5 % of all seeds: four standard errors instead.
  const double confidence = 0.99994;
  for (int b = 0; b <= 3; ++b) {
    // About +z the sky fills ±ψ; the rest meets the walls at the vertex itself, where E_b/π = sin²ψ cos²ᵇψ.
    const double wall = std::pow(std::sin(psi), 2) * std::pow(std::cos(psi), 2 * (b - 1));
    const double truth = b == 0 ? std::sin(psi) : (1 - std::sin(psi)) * wall;
    const RefereeInterval interval = referee_interval(measured, 0, b, confidence);
    EXPECT_TRUE(interval.contains(truth))
        << "vertex, E" << b << ": " << interval.mean << " expected " << truth;
  }
  const double s = 0.5, f = (std::cos(2 * psi) - s) / std::sqrt(1 + s * s - 2 * s * std::cos(2 * psi));
  EXPECT_TRUE(referee_interval(measured, 1, 0, confidence).contains((1 - f) / 2));

  // AO: at the vertex a lune of angle 2ψ is open, on the wall acos(f)/π.
  constexpr int kRays = 10'000;
  const std::vector<double> ao = referee_visible_fractions(surface, texels, kRays, 5);
  const auto tolerance = [](double share) { return 4 * std::sqrt(share * (1 - share) / kRays); };
  EXPECT_NEAR(ao[0], 2 * psi / kPi, tolerance(2 * psi / kPi));
  EXPECT_NEAR(ao[1], std::acos(f) / kPi, tolerance(std::acos(f) / kPi));
}

TEST(PathTracerClosedForms, SphericalPitIsTheSameEverywhere) {
  const SphericalPit pit = make_spherical_pit(128, kPi / 3);
  const double c = pit.escape_share;
  RefereeOptions options;
  options.paths = 2048;
  options.bounces = kBounces;
  const TexelSample sample = sample_texels(pit.texels, 2200, 1);
  const RefereeEstimates measured = referee_texels(pit.surface, sample.texels, options);
  for (int q = 0; q < measured.quantities; ++q) {
    std::vector<double> values, variances;
    for (size_t i = 0; i < sample.texels.size(); ++i) {
      values.push_back(measured.mean[measured.index(i, q)]);
      variances.push_back(measured.variance[measured.index(i, q)]);
    }
    const double truth = q <= kBounces ? c * std::pow(1 - c, q) : c / (1 - 0.5 * (1 - c));
    expect_holds(mean_from_sample(sample, values, variances, kConfidence), truth,
                 fmt::format("quantity {}", q));
  }
}

TEST(PathTracerClosedForms, BowlMapUpToItsRim) {
  // The cells across the rim of `synth bowl` cut from the sphere to the flat ground, so that the rim is known
  // to half a texel: ½/(R cos T) of polar angle, which moves C = (1 + cos T)/2 by ½ sin T times that, with R
  // = r/sin T.
  const double polar = kPi / 3;
  SyntheticOptions map_options;
  map_options.angle_rad = polar;
  const SyntheticMap map = synthesize(SyntheticKind::kBowl, map_options);
  const Surface surface = make_surface(map.heights, 1, map.recommended_amplitude_m, Edge::kWrap);
  const BowlGeometry bowl = bowl_geometry(map_options.width, map_options.height, polar);
  std::vector<uint32_t> population;
  for (int y = 0; y < surface.height(); ++y)
    for (int x = 0; x < surface.width(); ++x)
      if (std::hypot(x - bowl.center_x, y - bowl.center_y) < bowl.rim_radius - 2)
        population.push_back(static_cast<uint32_t>(surface.heights_m.index(x, y)));
  RefereeOptions options;
  options.bounces = kBounces;
  const TexelSample sample = sample_texels(population, 400, 1);
  const RefereeEstimates measured = referee_texels(surface, sample.texels, options);
  const double c = (1 + std::cos(polar)) / 2;
  const double c_error = 0.25 * std::tan(polar) * std::sin(polar) / bowl.rim_radius;
  for (int b = 0; b <= kBounces; ++b) {
    std::vector<double> values, variances;
    for (size_t i = 0; i < sample.texels.size(); ++i) {
      values.push_back(measured.mean[measured.index(i, b)]);
      variances.push_back(measured.variance[measured.index(i, b)]);
    }
    const RefereeInterval interval = mean_from_sample(sample, values, variances, kConfidence);
    const double truth = c * std::pow(1 - c, b);
    const double rim = truth * c_error * std::abs(1 / c - b / (1 - c));  // d ln(c (1 − c)^b)
    EXPECT_NEAR(interval.mean, truth, interval.half_width + rim) << "E" << b;
  }
}

TEST(PathTracerClosedForms, IntervalsHoldTheTruthAsOftenAsTheySay) {
  const double psi = kPi / 6;
  const Surface surface = make_groove(psi);
  const std::vector<double> truth = groove_wall_means(psi, kBounces);
  std::vector<int> held(truth.size());
  RefereeOptions options;
  options.paths = 8192;
  options.bounces = kBounces;
  for (options.seed = 0; options.seed < 100; ++options.seed) {
    const RefereeEstimates measured = referee_area(surface, options);
    for (size_t b = 0; b < truth.size(); ++b)
      held[b] += referee_interval(measured, 0, static_cast<int>(b), kConfidence).contains(truth[b]);
  }
  for (size_t b = 0; b < truth.size(); ++b) EXPECT_GE(held[b], 96) << "E" << b << " of 100 seeds";
}

}  // namespace
}  // namespace hemibake
