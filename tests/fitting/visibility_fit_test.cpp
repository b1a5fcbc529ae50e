#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "fitting/models.h"
#include "fitting/visibility.h"
#include "model/model.h"

namespace hemibake {
namespace {

// Makes curves over α in which g = escape(V, α) at V = α(1.4 − 0.4 α), forty bounces.
template <class Escape>
Curves exact_curves(Escape escape) {
  Curves curves;
  curves.bounce_count = 41;
  for (int j = 0; j < 100; ++j) {
    CurveBin bin{j / 100.0, (j + 1) / 100.0, (j + 0.5) / 100, 100, {}};
    const double ao = bin_center(bin), v = ao * (1.4 - 0.4 * ao), g = escape(v, ao);
    bin.bounces.push_back({kPi * v, 0.01});
    for (int b = 1; b <= 40; ++b) bin.bounces.push_back({kPi * (1 - v) * g * std::pow(1 - g, b - 1), 0.01});
    curves.bins.push_back(bin);
  }
  return curves;
}

Fit fit_one(const char* model, const Curves& curves) {
  return fit_model(model, curves, Abscissa::kCenter, Weights::kNone)[0].fit;
}

TEST(VisibilityFit, RecoversExactParameters) {
  const Curves over_v = exact_curves([](double v, double) { return 0.1 + 0.7 * v; });
  const Fit visibility = fit_one("visibility", over_v);
  EXPECT_NEAR(parameter_value(visibility, "dark"), 0.1, 1e-6);
  EXPECT_NEAR(parameter_value(visibility, "open"), 0.8, 1e-6);
  EXPECT_EQ(visibility.abscissa, Abscissa::kVisibility);
  EXPECT_LT(visibility.max_error, 1e-6);

  const Curves over_ao = exact_curves([](double, double ao) { return 0.2 + 0.6 * ao; });
  const Fit visibility_ao = fit_one("visibility-ao", over_ao);
  EXPECT_NEAR(parameter_value(visibility_ao, "dark"), 0.2, 1e-6);
  EXPECT_NEAR(parameter_value(visibility_ao, "open"), 0.8, 1e-6);
  EXPECT_EQ(visibility_ao.abscissa, Abscissa::kCenter);
}

TEST(VisibilityFit, CurvesOverVisibilityGiveTheSameModelOfVisibility) {
  Curves curves = exact_curves([](double v, double) { return 0.1 + 0.7 * v; });
  const Fit over_ao = fit_one("visibility", curves);
  curves.index = CurveIndex::kVisibility;
  for (CurveBin& bin : curves.bins) bin.low = bin.high = bin.mean = bin_visibility(bin);
  EXPECT_EQ(fit_one("visibility", curves).parameters[0].value, over_ao.parameters[0].value);
  EXPECT_EQ(fit_model("jimenez", curves, Abscissa::kCenter, Weights::kNone).size(), 1U);
}

TEST(VisibilityFit, ModelsOfAoRefuseCurvesOverVisibility) {
  Curves curves = exact_curves([](double v, double) { return v; });
  curves.index = CurveIndex::kVisibility;
  for (const FitModel& model : fit_models()) {
    if (!model.needs_ao) continue;
    try {
      fit_model(model.name, curves, Abscissa::kCenter, Weights::kNone);
      ADD_FAILURE() << model.name << " took curves over visibility";
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(),
                std::string("curves over visibility, expected curves over ao for the model ") + model.name);
    }
  }
  EXPECT_EQ(default_fit_models(CurveIndex::kVisibility), std::vector<std::string>{"visibility"});
}

// At V = 0 and g = 0 no light arrives below albedo 1, and all of it at 1: the fit's numbers stay finite.
TEST(VisibilityFit, ClosedPitsAndOpenGroundAreFinite) {
  Curves curves = exact_curves([](double, double ao) { return ao; });
  curves.bins.front().bounces.assign(41, {0, 0});
  curves.bins.back().bounces.assign(41, {0, 0});
  curves.bins.back().bounces[0].mean = kPi;
  for (const char* model : {"visibility", "visibility-ao"}) {
    const Fit fit = fit_one(model, curves);
    EXPECT_TRUE(std::isfinite(fit.rms)) << model;
    for (const FitParameter& parameter : fit.parameters) {
      EXPECT_GE(parameter.value, 0) << model;
      EXPECT_LE(parameter.value, 1) << model;
    }
  }
}

TEST(VisibilityFit, PredictionsAreThoseOfTheModels) {
  const Curves curves = exact_curves([](double, double ao) { return 0.2 + 0.6 * ao; });
  for (const char* name : {"published", "bounded", "visibility", "visibility-ao", "jimenez"}) {
    const auto fits = fit_model(name, curves, Abscissa::kCenter, Weights::kNone);
    const Prediction prediction = fit_model_called(name).predict(fits);
    for (const double x : {0.0, 0.3, 1.0})
      for (const double albedo : {0.0, 0.5, 1.0})
        EXPECT_TRUE(std::isfinite(prediction(x, x, albedo))) << name;
  }
  const auto fits = fit_model("visibility-ao", curves, Abscissa::kCenter, Weights::kNone);
  const VisibilityAoModel model{parameter_value(fits[0].fit, "dark"), parameter_value(fits[0].fit, "open")};
  EXPECT_EQ(fit_model_called("visibility-ao").predict(fits)(0.3, 0.4, 0.5), model.total(0.4, 0.3, 0.5));
}

}  // namespace
}  // namespace hemibake
