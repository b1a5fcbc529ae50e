#include "trade/light_models.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hemibake {
namespace {

RunPlanes ramp(size_t texels) {
  RunPlanes planes;
  planes.uniform = planes.cosine = Grid<float>(static_cast<int>(texels), 1);
  for (size_t i = 0; i < texels; ++i) {
    const double ao = static_cast<double>(i) / static_cast<double>(texels - 1);
    planes.uniform[i] = static_cast<float>(ao);
    planes.cosine[i] = static_cast<float>(ao * (1.5 - 0.5 * ao));
  }
  return planes;
}

// The truth is what one model says: that model has no error, and the others have.
void expect_only_right(const std::string& model, const FittedModels& fitted,
                       const std::function<double(double uniform, double cosine, double albedo)>& light) {
  RunPlanes truth = ramp(501);
  for (size_t a = 0; a < kJudgedAlbedos.size(); ++a) {
    truth.all_bounces[a] = truth.uniform;
    for (size_t i = 0; i < truth.uniform.size(); ++i)
      truth.all_bounces[a][i] =
          static_cast<float>(light(truth.uniform[i], truth.cosine[i], kJudgedAlbedos[a]));
  }
  bool found = false;
  for (const LightModelErrors& errors : light_model_errors(truth, fitted, truth)) {
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a) {
      // Stored in float.
      if (errors.model == model)
        EXPECT_LT(errors.error[a].largest, 1e-6) << model;
      else
        EXPECT_GT(errors.error[a].largest, 1e-3) << model << " against " << errors.model;
    }
    found = found || errors.model == model;
  }
  EXPECT_TRUE(found) << model;
}

TEST(LightModels, AreTheFormulasTheyAreNamedFor) {
  const Mayaux2018Model refit{0.4, 1.2, 20, 3.2};
  const BoundedModel bounded{0.3, 0.9, 0.6, 0.7};
  const FittedModels fitted{refit, bounded};
  expect_only_right("plain", fitted, [](double a, double, double) { return a; });
  expect_only_right("f0", fitted, [](double a, double, double) {
    return std::min(1.0, a * (1 + 0.5 * std::pow(1 - a, 0.75)));
  });
  expect_only_right("eq12-published", fitted,
                    [](double a, double, double rho) { return GuardedModel{}.total(a, rho); });
  expect_only_right("eq12-refitted", fitted,
                    [&](double a, double, double rho) { return GuardedModel{refit}.total(a, rho); });
  expect_only_right("bounded", fitted, [&](double a, double, double rho) { return bounded.total(a, rho); });
  // The cubic takes the cosine-weighted fraction.
  expect_only_right("jimenez", fitted,
                    [](double, double v, double rho) { return JimenezModel{}.total(v, rho); });
}

TEST(LightModels, WithoutConstantsAreLeftOut) {
  RunPlanes truth = ramp(11);
  for (Grid<float>& plane : truth.all_bounces) plane = truth.uniform;
  for (const LightModelErrors& errors : light_model_errors(truth, {}, truth)) {
    EXPECT_NE(errors.model, "bounded");
    EXPECT_NE(errors.model, "eq12-refitted");
  }
  EXPECT_TRUE(light_model_errors({}, {}, truth).empty());
}

// Flat ground has one AO: nothing to fit.
TEST(LightModels, FlatGroundHasNoFit) {
  Bake bake;
  bake.width = bake.height = 4;
  bake.visible_fraction = Grid<float>(4, 4, 1.0f);
  bake.irradiance = {Grid<float>(4, 4, 3.14159f), Grid<float>(4, 4, 0.0f)};
  const FittedModels fitted = fit_light_models(make_curves(bake, 100));
  EXPECT_FALSE(fitted.eq12);
  EXPECT_FALSE(fitted.bounded);
}

}  // namespace
}  // namespace hemibake
