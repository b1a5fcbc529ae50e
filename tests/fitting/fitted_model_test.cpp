// Models of the constants that fits hold.
#include "fitting/fitted_model.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace hemibake {
namespace {

std::vector<NamedFit> some_fits() {
  std::vector<NamedFit> fits(4);
  fits[0].name = "F0";
  fits[0].fit.parameters = {{"k", 0.5, 0.01}, {"e", 0.75, 0.02}};
  fits[1].name = "F1";
  fits[1].fit.parameters = {{"A", 27, 0.3}, {"B", 3.3, 0.02}};
  fits[2].name = "bounded_F0";
  fits[2].fit = {"bounded F0", "f", {{"k0", 0.1, 0.01}, {"k1", 1, std::nullopt}}, {}, 0.02, 0.05, 100, {}};
  fits[3].name = "bounded_tau";
  fits[3].fit = {"bounded tau", "g", {{"q", 0.4, 0.01}, {"d", 0.9, 0.1}}, {}, 0.03, 0.06, 900, {}};
  return fits;
}

std::string error_of(const std::vector<NamedFit>& fits, ModelKind kind) {
  try {
    fitted_model(fits, kind);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(FittedModel, HasTheConstantsOfItsFits) {
  const std::vector<NamedFit> fits = some_fits();
  const auto bounded = std::get<BoundedModel>(fitted_model(fits, ModelKind::kBounded));
  EXPECT_EQ(bounded.k0, 0.1);
  EXPECT_EQ(bounded.k1, 1);
  EXPECT_EQ(bounded.q, 0.4);
  EXPECT_EQ(bounded.d, 0.9);
  const Mayaux2018Model formulas =
      std::get<GuardedModel>(fitted_model(fits, ModelKind::kMayaux2018)).formulas;
  EXPECT_EQ(formulas.k, 0.5);
  EXPECT_EQ(formulas.e, 0.75);
  EXPECT_EQ(formulas.a, 27);
  EXPECT_EQ(formulas.b, 3.3);
}

TEST(FittedModel, NamesWhatIsMissingOrOutOfRange) {
  std::vector<NamedFit> fits = some_fits();
  EXPECT_TRUE(has_model(fits, ModelKind::kBounded));
  fits[3].fit.parameters[1].value = 1;
  EXPECT_EQ(error_of(fits, ModelKind::kBounded), "d of bounded tau is 1, expected 0 to 0.999999");
  fits[3].fit.parameters.pop_back();
  EXPECT_EQ(error_of(fits, ModelKind::kBounded), "bounded tau has no parameter d, expected one");
  fits.pop_back();
  EXPECT_FALSE(has_model(fits, ModelKind::kBounded));
  EXPECT_EQ(error_of(fits, ModelKind::kBounded), "no fit bounded_tau, expected the fits of model 'bounded'");
  EXPECT_TRUE(has_model(fits, ModelKind::kMayaux2018));
}

TEST(FittedModel, EscapesComeFromTheirFits) {
  std::vector<NamedFit> fits(1);
  fits[0].name = "visibility_ao";
  fits[0].fit.parameters = {{"dark", 0.1, 0.01}, {"open", 0.9, 0.01}};
  const auto model = std::get<VisibilityAoModel>(any_fitted_model(fits, ModelKind::kVisibilityAo));
  EXPECT_EQ(model.dark, 0.1);
  EXPECT_EQ(model.open, 0.9);
  EXPECT_THROW(any_fitted_model(fits, ModelKind::kVisibility), InputError);
  fits[0].fit.parameters[1].value = 1.01;
  EXPECT_THROW(any_fitted_model(fits, ModelKind::kVisibilityAo), InputError);
}

TEST(FittedModel, OnlyTheBoundedModelNeedsFits) {
  for (const std::string& name : model_kind_names()) {
    const ModelKind kind = model_kind_from_string(name);
    EXPECT_EQ(model_without_fits(kind).has_value(), kind != ModelKind::kBounded) << name;
  }
}

TEST(FittedModel, KindsHaveTheNamesOfTheCommandLine) {
  EXPECT_EQ(model_kind_from_string("bounded"), ModelKind::kBounded);
  EXPECT_EQ(model_kind_from_string("published"), ModelKind::kMayaux2018);
  EXPECT_THROW(model_kind_from_string("mayaux2018"), InputError);
}

TEST(FittedModel, DescribesEachFitInALine) {
  EXPECT_EQ(describe_fits(some_fits(), ModelKind::kBounded),
            (std::vector<std::string>{
                "bounded F0 = f with k0 = 0.1 +- 0.01 k1 = 1 (a = ao; rms 0.02, max 0.05)",
                "bounded tau = g with q = 0.4 +- 0.01 d = 0.9 +- 0.1 (a = ao; rms 0.03, max 0.06)"}));
}

}  // namespace
}  // namespace hemibake
