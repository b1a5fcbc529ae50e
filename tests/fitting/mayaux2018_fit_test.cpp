#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

#include "core/constants.h"
#include "core/error.h"
#include "fitting/fit.h"
#include "fitting/mayaux2018.h"
#include "model/closed_forms.h"

namespace hemibake {
namespace {

// 100 bins of 100 texels that follow F₀(k, e) and F₁(A, B) exactly.
Curves exact_curves(double k, double e, double a, double b) {
  Curves curves;
  curves.bounce_count = 2;
  for (int j = 0; j < 100; ++j) {
    CurveBin bin{j / 100.0, (j + 1) / 100.0, (j + 0.5) / 100, 100, {}};
    const double ao = bin_center(bin);
    bin.bounces = {{kPi * direct_factor(ao, k, e), 0.1}, {kPi * first_bounce_factor(ao, a, b), 0.1}};
    curves.bins.push_back(bin);
  }
  return curves;
}

std::vector<CurvePoint> points_of(const Curves& curves, int bounce, Weights weights = Weights::kNone) {
  return curve_points(curves, bounce, Abscissa::kCenter, weights);
}

TEST(PublishedFit, RecoversExactParameters) {
  for (const auto& [k, e, a, b] : {std::array{0.5, 0.75, 27.6, 3.34}, std::array{0.8, 1.03, 38.4, 3.85},
                                   std::array{0.1, 2.5, 3.0, 0.5}, std::array{-0.3, 0.4, 400.0, 9.0}}) {
    const Curves curves = exact_curves(k, e, a, b);
    const Fit direct = fit_direct(points_of(curves, 0));
    EXPECT_NEAR(parameter_value(direct, "k"), k, 1e-7);
    EXPECT_NEAR(parameter_value(direct, "e"), e, 1e-7);
    EXPECT_LT(direct.max_error, 1e-9);
    const Fit first = fit_first_bounce(points_of(curves, 1));
    EXPECT_NEAR(parameter_value(first, "A") / a, 1, 1e-7);
    EXPECT_NEAR(parameter_value(first, "B"), b, 1e-7);
    EXPECT_EQ(first.points, 100);
  }
}

// How often the true parameter lies within the stated standard error, over many noisy curves whose noise has
// the variance the weights say: 68.3 % ± 4 standard errors of a binomial share.
void expect_honest_errors(Weights weights) {
  const double k = 0.8, e = 1.05, a = 38, b = 3.8;
  const int trials = 400;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  int within[4] = {};
  for (int t = 0; t < trials; ++t) {
    Curves curves = exact_curves(k, e, a, b);
    for (CurveBin& bin : curves.bins) {
      bin.count = weights == Weights::kNone ? 100 : 10 + 400 * bin.low;
      const double stddev = weights == Weights::kStandardError ? 0.05 + 0.3 * bin.high : 0.2;
      for (BounceStatistics& bounce : bin.bounces) {
        bounce.stddev = stddev;
        bounce.mean += stddev / std::sqrt(bin.count) * normal(random);
      }
    }
    const Fit direct = fit_direct(points_of(curves, 0, weights));
    const Fit first = fit_first_bounce(points_of(curves, 1, weights));
    const double truth[4] = {k, e, a, b};
    for (int p = 0; p < 4; ++p) {
      const FitParameter& found = (p < 2 ? direct : first).parameters[static_cast<size_t>(p % 2)];
      within[p] += std::abs(found.value - truth[p]) < found.standard_error.value();
    }
  }
  const double expected = 0.683;
  const double tolerance = 4 * std::sqrt(expected * (1 - expected) / trials);
  for (const int count : within) EXPECT_NEAR(static_cast<double>(count) / trials, expected, tolerance);
}

TEST(PublishedFit, StandardErrorsCoverUnweighted) { expect_honest_errors(Weights::kNone); }
TEST(PublishedFit, StandardErrorsCoverWeightedByCount) { expect_honest_errors(Weights::kCount); }
TEST(PublishedFit, StandardErrorsCoverWeightedByStandardError) {
  expect_honest_errors(Weights::kStandardError);
}

TEST(PublishedFit, EmptyBinsAreSkipped) {
  Curves curves = exact_curves(0.8, 1.05, 38, 3.8);
  for (size_t j = 0; j < 100; j += 3)
    curves.bins[j] = {curves.bins[j].low, curves.bins[j].high, 0, 0, {{}, {}}};
  const Fit first = fit_first_bounce(points_of(curves, 1));
  EXPECT_EQ(first.points, 66);
  EXPECT_NEAR(parameter_value(first, "A"), 38, 1e-5);
}

TEST(PublishedFit, WeightsHaveMeanOneAndFollowTheirSource) {
  Curves curves = exact_curves(0.8, 1.05, 38, 3.8);
  curves.bins[3].count = 900;
  curves.bins[4].count = 1;
  const std::vector<CurvePoint> by_count = points_of(curves, 0, Weights::kCount);
  double sum = 0;
  for (const CurvePoint& point : by_count) sum += point.weight;
  EXPECT_NEAR(sum, 100, 1e-10);
  EXPECT_NEAR(by_count[3].weight / by_count[0].weight, 9, 1e-12);
  const std::vector<CurvePoint> by_error = points_of(curves, 0, Weights::kStandardError);
  EXPECT_EQ(by_error.size(), 99U);  // one texel has no spread
  EXPECT_NEAR(by_error[3].weight / by_error[0].weight, 9, 1e-12);
}

TEST(PublishedFit, PublishedAbscissaIsOneBinFurther) {
  const std::vector<CurvePoint> points =
      curve_points(exact_curves(0.8, 1, 38, 3.8), 1, Abscissa::kMayaux2018, Weights::kNone);
  EXPECT_DOUBLE_EQ(points.front().ao, 1 / 99.0);
  EXPECT_DOUBLE_EQ(points[98].ao, 1);
  EXPECT_DOUBLE_EQ(points.back().ao, 100 / 99.0);
}

TEST(PublishedFit, TooFewPointsAreRefused) {
  Curves curves = exact_curves(0.8, 1.05, 38, 3.8);
  curves.bins.resize(2);
  EXPECT_THROW(fit_direct(points_of(curves, 0)), InputError);
  EXPECT_THROW(fit_direct({}), InputError);
  curves.has_counts = false;
  EXPECT_THROW(points_of(curves, 0, Weights::kCount), InputError);
}

TEST(PublishedFit, WhatThePointsDoNotDetermineIsAFailedCheck) {
  EXPECT_THROW(fit_first_bounce(points_of(exact_curves(0.8, 1.05, 0, 3.8), 1)),
               CheckError);                                                           // no light: B is free
  EXPECT_THROW(fit_direct(points_of(exact_curves(0, 1.05, 0, 3.8), 0)), CheckError);  // plain AO: e is free
}

TEST(PublishedFit, TwentyOneCurvesTakeUnderAFifthOfASecond) {
  const Curves curves = exact_curves(0.8, 1.05, 38, 3.8);
  const auto start = std::chrono::steady_clock::now();
  fit_direct(points_of(curves, 0));
  for (int b = 1; b <= 20; ++b) fit_first_bounce(points_of(curves, 1));
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  EXPECT_LT(seconds.count(), 0.2);
}

}  // namespace
}  // namespace hemibake
