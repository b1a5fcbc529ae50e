#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/constants.h"
#include "core/error.h"
#include "fitting/bounded.h"
#include "fitting/candidates.h"
#include "fitting/mayaux2018.h"
#include "fitting/models.h"
#include "model/model.h"

namespace hemibake {
namespace {

// 100 bins that follow a bounded model exactly, `bounces` bounces of it.
Curves exact_curves(const BoundedModel& model, int bounces) {
  Curves curves;
  curves.bounce_count = bounces + 1;
  for (int j = 0; j < 100; ++j) {
    CurveBin bin{j / 100.0, (j + 1) / 100.0, (j + 0.5) / 100, 100, {}};
    const double ao = bin_center(bin);
    bin.bounces.push_back({kPi * model.direct(ao), 0.1});
    double bounce = kPi * model.first_bounce(ao);
    for (int b = 1; b <= bounces; ++b, bounce *= model.bounce_ratio(ao)) bin.bounces.push_back({bounce, 0.1});
    curves.bins.push_back(bin);
  }
  return curves;
}

std::vector<NamedFit> fit_bounded(const Curves& curves) {
  return fit_model("bounded", curves, Abscissa::kCenter, Weights::kNone);
}

TEST(BoundedFit, RecoversExactParameters) {
  for (const BoundedModel& model : {BoundedModel{0.5, 0.9, 0.95, 0.77}, BoundedModel{-0.2, 0.8, 0.35, 0.9},
                                    BoundedModel{0.3, 0.3, 0.6, 0.1}}) {
    const std::vector<NamedFit> fits = fit_bounded(exact_curves(model, 20));
    EXPECT_NEAR(parameter_value(fits[0].fit, "k0"), model.k0, 1e-7);
    EXPECT_NEAR(parameter_value(fits[0].fit, "k1"), model.k1, 1e-7);
    EXPECT_NEAR(parameter_value(fits[1].fit, "q"), model.q, 1e-6);
    EXPECT_NEAR(parameter_value(fits[1].fit, "d"), model.d, 1e-6);
    EXPECT_TRUE(fit_warnings(fits).empty());
  }
}

TEST(BoundedFit, TotalsContinueTheBouncesAsAGeometricSeries) {
  const BoundedModel model{0.5, 0.9, 0.3, 0.5};
  for (const int bounces : {2, 3, 20}) {
    const Curves curves = exact_curves(model, bounces);
    for (const double albedo : {0.0, 0.5, 0.95, 1.0}) {
      EXPECT_NEAR(total_over_pi(curves.bins[20], albedo), model.total(0.205, albedo), 1e-12);
    }
  }
}

TEST(BoundedFit, StaysInItsBoundsAndSaysSo) {
  Curves curves = exact_curves({1, 1, 1, 0}, 20);
  for (CurveBin& bin : curves.bins) bin.bounces[0].mean *= 1.05;  // more light than any surface lets in
  const std::vector<NamedFit> fits = fit_bounded(curves);
  EXPECT_LE(parameter_value(fits[0].fit, "k1"), 1);
  EXPECT_LE(parameter_value(fits[0].fit, "k0"), 1);
  EXPECT_FALSE(fits[0].fit.parameters[1].standard_error.has_value() &&
               fits[0].fit.parameters[0].standard_error);
  EXPECT_FALSE(fit_warnings(fits).empty());
}

// The noise of a bin is the same at every albedo, as where a bin's texels are not the average ones: the
// standard errors of τ count it once. 68.3 % ± 4 standard errors of a binomial share.
TEST(BoundedFit, StandardErrorsCover) {
  const BoundedModel truth{0.4, 0.9, 0.6, 0.8};
  const int trials = 400;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  const Fit direct =
      fit_bounded_direct(curve_points(exact_curves(truth, 20), 0, Abscissa::kCenter, Weights::kNone));
  const std::vector<double> albedos = fit_albedos();
  int within[2] = {};
  for (int t = 0; t < trials; ++t) {
    std::vector<CurvePoint> points =
        total_points(exact_curves(truth, 20), albedos, Abscissa::kCenter, Weights::kNone);
    for (size_t i = 0; i < points.size(); i += albedos.size()) {
      const double noise = 0.01 * normal(random);
      for (size_t r = 0; r < albedos.size(); ++r) points[i + r].value += noise;
    }
    const Fit fit = fit_bounded_tau(points, static_cast<int>(albedos.size()), direct);
    within[0] += std::abs(fit.parameters[0].value - truth.q) < fit.parameters[0].standard_error.value();
    within[1] += std::abs(fit.parameters[1].value - truth.d) < fit.parameters[1].standard_error.value();
  }
  const double expected = 0.683;
  const double tolerance = 4 * std::sqrt(expected * (1 - expected) / trials);
  for (const int count : within) EXPECT_GE(static_cast<double>(count) / trials, expected - tolerance);
}

TEST(BounceFit, RecoversExactParameters) {
  Curves curves = exact_curves({}, 1);
  for (const auto& [a, b, c] :
       {std::array{56.0, 4.1, 0.2}, std::array{28.0, 39.0, 0.6}, std::array{1.5, 1.1, 0.9}}) {
    for (CurveBin& bin : curves.bins) bin.bounces[1].mean = kPi * bounce_factor(bin_center(bin), a, b, c);
    const std::vector<NamedFit> fits = fit_model("bounces", curves, Abscissa::kCenter, Weights::kNone);
    ASSERT_EQ(fits.size(), 1U);
    EXPECT_NEAR(parameter_value(fits[0].fit, "A") / a, 1, 1e-5);
    EXPECT_NEAR(parameter_value(fits[0].fit, "B"), b, 1e-4);
    EXPECT_NEAR(parameter_value(fits[0].fit, "C"), c, 1e-6);
  }
}

TEST(JimenezFit, RecoversTheirConstants) {
  Curves curves = exact_curves({}, 2);
  std::vector<CurvePoint> points = total_points(curves, fit_albedos(), Abscissa::kVisibility, Weights::kNone);
  for (CurvePoint& point : points) {
    point.value = jimenez_cubic(point.ao, point.albedo, kJimenezConstants.data());
  }
  const Fit fit = fit_jimenez(points, static_cast<int>(fit_albedos().size()));
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(fit.parameters[i].value, kJimenezConstants[i], 1e-9);
}

TEST(Candidates, TheRightOneIsExactOnItsOwnCurves) {
  const std::vector<Curves> sets = {exact_curves({0.5, 0.9, 0.9, 0.77}, 20),
                                    exact_curves({0.5, 0.9, 0.9, 0.77}, 20)};
  for (const Candidate& candidate : candidates()) {
    const Comparison comparison = compare_candidate(candidate, sets);
    ASSERT_EQ(comparison.own.size(), 2U);
    ASSERT_EQ(comparison.others.size(), 2U);
    if (candidate.name == std::string("bounded")) {
      EXPECT_LT(comparison.own[0].max_error, 1e-8);
      EXPECT_LT(comparison.others[0].max_error, 1e-8);
    } else {
      EXPECT_GT(comparison.own[0].rms, 1e-4) << candidate.name;
    }
  }
}

TEST(FitModel, MissingBouncesAndUnknownNamesAreRefused) {
  const Curves direct_only = exact_curves({}, 0);
  for (const FitModel& model : fit_models()) {
    EXPECT_THROW(fit_model(model.name, direct_only, Abscissa::kCenter, Weights::kNone), InputError);
  }
  EXPECT_THROW(fit_model("none", exact_curves({}, 2), Abscissa::kCenter, Weights::kNone), InputError);
}

}  // namespace
}  // namespace hemibake
