// Float against double for every function of the models, as a table: run with
// --gtest_filter=Stability.* to see it; fits/README.md shows it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "model/model.h"

namespace hemibake {
namespace {

struct Errors {
  double absolute = 0, relative = 0;
  double absolute_ao = 0, absolute_albedo = 0;  // where the largest absolute error is
  bool finite = true;
};

// α and ρ in 0..1: a grid, the ends, what is one float away from them and the trouble spots of the published
// model.
std::vector<float> sample_inputs() {
  std::vector<float> inputs = {0.0F, 1e-7F, 1e-5F, 1e-3F, 0.9492F, 0.949253F, 0.97F, 0.999F, 1 - 1e-7F, 1.0F};
  for (int i = 1; i < 500; ++i) inputs.push_back(static_cast<float>(i) / 500.0F);
  return inputs;
}

// function(x, y) in float against double at the same inputs.
template <class Function>
Errors compare(Function function) {
  Errors errors;
  const std::vector<float> inputs = sample_inputs();
  for (const float ao : inputs) {
    for (const float albedo : inputs) {
      const double exact = function(static_cast<double>(ao), static_cast<double>(albedo));
      const double rounded = static_cast<double>(function(ao, albedo));
      if (!std::isfinite(rounded) || !std::isfinite(exact)) {
        errors.finite = false;
        continue;
      }
      const double error = std::abs(rounded - exact);
      if (error > errors.absolute) {
        errors.absolute = error;
        errors.absolute_ao = static_cast<double>(ao);
        errors.absolute_albedo = static_cast<double>(albedo);
      }
      if (exact != 0) errors.relative = std::max(errors.relative, error / std::abs(exact));
    }
  }
  return errors;
}

void print_row(const std::string& name, const Errors& e) {
  fmt::print("| {:28} | {:8.1e} | {:8.1e} | {:.7g}, {:.7g} | {} |\n", name, e.absolute, e.relative,
             e.absolute_ao, e.absolute_albedo, e.finite ? "yes" : "**no**");
}

template <class Model>
std::vector<Errors> print_rows(const std::string& name, const Model& model) {
  const std::vector<std::pair<std::string, Errors>> rows = {
      {"direct", compare([&](auto ao, auto) { return model.direct(ao); })},
      {"first_bounce", compare([&](auto ao, auto) { return model.first_bounce(ao); })},
      {"bounce_ratio", compare([&](auto ao, auto) { return model.bounce_ratio(ao); })},
      {"total", compare([&](auto ao, auto albedo) { return model.total(ao, albedo); })},
  };
  std::vector<Errors> errors;
  for (const auto& [function, e] : rows) {
    print_row(name + " " + function, e);
    errors.push_back(e);
  }
  return errors;
}

void print_head() {
  fmt::print(
      "| function | absolute | relative | at ao, albedo | finite |\n| --- | --- | --- | --- | --- |\n");
}

// A float holds 6·10⁻⁸ of 1; a dozen operations on values up to 1 lose less than 2·10⁻⁶ (the bar of the
// export).
TEST(Stability, BoundedModelKeepsFloatPrecision) {
  print_head();
  for (const Errors& e : print_rows("bounded", BoundedModel{0.518118, 0.910617, 0.9, 0.765505})) {
    EXPECT_TRUE(e.finite);
    EXPECT_LE(e.absolute, 2e-6);
    EXPECT_LE(e.relative, 2e-6);
  }
}

TEST(Stability, GuardedModelIsFiniteAndLosesDigitsOnlyWhereTheFormulasCancel) {
  print_head();
  const std::vector<Errors> errors = print_rows("published, cut", GuardedModel{});
  for (const Errors& e : errors) EXPECT_TRUE(e.finite);
  EXPECT_LE(errors[0].absolute, 2e-6);
  EXPECT_LE(errors[1].absolute, 2e-6);
  EXPECT_LE(errors[3].absolute, 2e-6);
}

TEST(Stability, PublishedModelFailsNearItsPoles) {
  print_head();
  const std::vector<Errors> errors = print_rows("published", Mayaux2018Model{});
  EXPECT_FALSE(errors[2].finite);  // τ = 1 − 0/0 at α = 1
  EXPECT_FALSE(errors[3].finite);
  EXPECT_GT(errors[2].absolute, 1e-2);  // beside the pole at 0.949253
  EXPECT_GT(errors[3].absolute, 1e-5);
}

TEST(Stability, JimenezCubicKeepsFloatPrecision) {
  print_head();
  const Errors e =
      compare([](auto visibility, auto albedo) { return JimenezModel{}.total(visibility, albedo); });
  print_row("Jimenez total", e);
  EXPECT_TRUE(e.finite);
  EXPECT_LE(e.absolute, 2e-6);
}

}  // namespace
}  // namespace hemibake
