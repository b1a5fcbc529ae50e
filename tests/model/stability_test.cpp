// Float against double for every function of the models, as a table: run with
// --gtest_filter=Stability.* to see it; fits/README.md shows it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fitting/fitted_model.h"
#include "io/fit_file.h"
#include "model/check_model.h"
#include "model/model.h"

namespace hemibake {
namespace {

// Reads every fit of the repository.
std::vector<FitFile> stored_fits() {
  std::vector<FitFile> files;
  for (const auto& entry : std::filesystem::directory_iterator(HEMIBAKE_SOURCE_DIR "/fits"))
    if (entry.path().extension() == ".json") files.push_back(read_fits(entry.path()));
  return files;
}

std::string name_of(const FitFile& file) {
  return file.provenance.is_object() ? file.provenance.value("input", "fit") : "fit";
}

void expect_all_passed(const Checks& checks) {
  for (const Check& check : checks) EXPECT_TRUE(check.passed()) << check.quantity << " " << check.value;
}

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

// The constants that the repository recommends, as they are today: d sits on its bound there.
TEST(Stability, RecommendedBoundedConstantsKeepFloatPrecision) {
  print_head();
  int count = 0;
  for (const FitFile& file : stored_fits()) {
    if (!has_model(file.fits, ModelKind::kBounded)) continue;
    ++count;
    const BoundedModel model = std::get<BoundedModel>(any_fitted_model(file.fits, ModelKind::kBounded));
    const std::vector<Errors> errors = print_rows(name_of(file), model);
    for (size_t i = 0; i < errors.size(); ++i) {
      EXPECT_TRUE(errors[i].finite);
      EXPECT_LE(errors[i].absolute, 3e-7);
      if (i == 2) continue;  // τ may come near 0
      EXPECT_LE(errors[i].relative, 2e-6) << i;
    }
    expect_all_passed(check_model(model, 1e-6));
  }
  EXPECT_GE(count, 6);
}

// The escape models with the constants of fits/ that hold them, without constants, and the corners of their
// ranges.
TEST(Stability, EscapeModelsKeepFloatPrecision) {
  print_head();
  std::vector<std::pair<std::string, VisibilityModel>> models = {
      {"g = V", {0, 1}}, {"g = 0", {0, 0}}, {"g = 1", {1, 1}}, {"g = 1 - V", {1, 0}}};
  for (const FitFile& file : stored_fits())
    for (const ModelKind kind : {ModelKind::kVisibility, ModelKind::kVisibilityAo}) {
      if (!has_model(file.fits, kind)) continue;
      const AnyModel any = any_fitted_model(file.fits, kind);
      if (const auto* of_ao = std::get_if<VisibilityAoModel>(&any))
        models.push_back({name_of(file) + " V, ao", {of_ao->dark, of_ao->open}});
      else
        models.push_back({name_of(file) + " V", std::get<VisibilityModel>(any)});
    }
  for (const auto& [name, fitted] : models) {
    const auto& model = fitted;  // Clang 14 does not capture structured bindings
    const Errors of_visibility =
        compare([&](auto visibility, auto albedo) { return model.total(visibility, albedo); });
    print_row(name + " total", of_visibility);
    EXPECT_TRUE(of_visibility.finite);
    // 1 − V and 1 − ρ are exact to half a unit of 1; their relative error grows only where E is near 1.
    EXPECT_LE(of_visibility.absolute, 3e-7);
    expect_all_passed(check_model(model, 1e-6));
    expect_all_passed(check_model(VisibilityAoModel{model.dark, model.open}, 1e-6));
  }
}

// Holds the largest violations of what the two-texture form promises.
struct Worst {
  double below = 0, above = 0;  // outside [V, 1]
  double fall_in_visibility = 0, fall_in_bounce = 0, fall_in_albedo = 0;
  double off_ends = 0;  // from V, E_r and 1 at the albedos 0, r and 1
  int not_finite = 0;
};

// Evaluates the two-texture form on every pair of bytes with bounce >= visibility, in the number type T.
template <class T>
Worst bounce_map_square(double r) {
  const BounceMapModel model{r};
  const double albedos[] = {0, 0.25, 0.5, r, 0.95, 0.999999, 1};
  const auto byte = [](int i) { return static_cast<T>(static_cast<float>(i) / 255.0F); };
  const auto total = [&](int v, int b, double albedo) {
    return static_cast<double>(model.total(byte(v), byte(b), static_cast<T>(albedo)));
  };
  Worst worst;
  const auto grow = [](double& value, double by) { value = std::max(value, by); };
  for (int v = 0; v < 256; ++v)
    for (int b = 0; b < 256; ++b) {
      double before = 0;
      const double visibility = static_cast<double>(byte(v));
      const double bounce = static_cast<double>(byte(std::max(v, b)));
      for (const double albedo : albedos) {
        const double e = total(v, b, albedo);
        worst.not_finite += !std::isfinite(e);
        grow(worst.below, visibility - e);
        grow(worst.above, e - 1);
        grow(worst.fall_in_albedo, before - e);
        before = e;
        if (b < 255) grow(worst.fall_in_bounce, e - total(v, b + 1, albedo));
        // With E_r fixed, E at an albedo beyond r falls as V rises.
        if (v < 255 && albedo <= r) grow(worst.fall_in_visibility, e - total(v + 1, b, albedo));
        if (albedo == 0) grow(worst.off_ends, std::abs(e - visibility));
        if (albedo == r) grow(worst.off_ends, std::abs(e - bounce));
        if (albedo == 1) grow(worst.off_ends, std::abs(e - 1));
      }
    }
  return worst;
}

// A few roundings, each half a unit in the last place of 1.
template <class T>
void expect_bounce_map_stable(const char* name, double unit) {
  for (const double r : {0.8, 0.9, 0.95}) {
    const Worst w = bounce_map_square<T>(r);
    fmt::print("| bounce map, {}, r = {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {} |\n", name, r,
               std::max(w.below, w.above), w.fall_in_albedo, w.fall_in_bounce, w.fall_in_visibility,
               w.off_ends, w.not_finite == 0 ? "yes" : "**no**");
    EXPECT_EQ(w.not_finite, 0) << name << r;
    EXPECT_LE(w.above, 0) << name << r;
    EXPECT_LE(w.below, unit) << name << r;
    EXPECT_LE(w.fall_in_albedo, 2 * unit) << name << r;
    EXPECT_LE(w.fall_in_bounce, 2 * unit) << name << r;
    EXPECT_LE(w.fall_in_visibility, 4 * unit) << name << r;
    EXPECT_LE(w.off_ends, 4 * unit) << name << r;
  }
}

// Holds the largest violations of what an escape model of V and a second input promises.
struct EscapeWorst {
  double outside = 0;  // [V, 1]
  double fall_in_visibility = 0, fall_in_albedo = 0;
  double off_ends = 0;  // from V at albedo 0 and from 1 at albedo 1
  int not_finite = 0;
};

// Evaluates a model over 101 × 101 inputs in the number type T, ends included.
template <class T, class Model>
EscapeWorst escape_square(const Model& model) {
  constexpr int kSteps = 100;
  const auto total = [&](int v, int second, double albedo) {
    const T x = static_cast<T>(static_cast<float>(v) / kSteps);
    const T y = static_cast<T>(static_cast<float>(second) / kSteps);
    return static_cast<double>(model.total(x, y, static_cast<T>(albedo)));
  };
  EscapeWorst worst;
  const auto grow = [](double& value, double by) { value = std::max(value, by); };
  for (int v = 0; v <= kSteps; ++v)
    for (int second = 0; second <= kSteps; ++second) {
      const double visibility = static_cast<double>(static_cast<T>(static_cast<float>(v) / kSteps));
      double before = 0;
      for (const double albedo : {0.0, 0.2, 0.5, 0.8, 0.9, 0.95, 0.999999, 1.0}) {
        const double e = total(v, second, albedo);
        worst.not_finite += !std::isfinite(e);
        grow(worst.outside, std::max(visibility - e, e - 1));
        grow(worst.fall_in_albedo, before - e);
        before = e;
        if (v < kSteps) grow(worst.fall_in_visibility, e - total(v + 1, second, albedo));
        if (albedo == 0) grow(worst.off_ends, std::abs(e - visibility));
        if (albedo == 1) grow(worst.off_ends, std::abs(e - 1));
      }
    }
  return worst;
}

template <class T, class Model>
void expect_escape_stable(const char* name, const char* type, const Model& model, double unit) {
  const EscapeWorst w = escape_square<T>(model);
  fmt::print("| {}, {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {} |\n", name, type, w.outside, w.fall_in_albedo,
             w.fall_in_visibility, w.off_ends, w.not_finite == 0 ? "yes" : "**no**");
  EXPECT_EQ(w.not_finite, 0) << name << type;
  EXPECT_LE(w.outside, unit) << name << type;
  EXPECT_LE(w.fall_in_albedo, 2 * unit) << name << type;
  EXPECT_LE(w.fall_in_visibility, 2 * unit) << name << type;
  EXPECT_LE(w.off_ends, unit) << name << type;
}

template <class Model>
void expect_escape_stable_in_every_type(const char* name, const Model& model) {
  expect_escape_stable<double>(name, "double", model, 0x1p-52);
  expect_escape_stable<float>(name, "float", model, 0x1p-23);
#ifdef __FLT16_MANT_DIG__
  __extension__ using Half = _Float16;
  expect_escape_stable<Half>(name, "half", model, 0x1p-10);
#endif
  expect_all_passed(check_model(model, 1e-6));
}

TEST(Stability, EscapesOfTwoInputsHoldInEveryNumberType) {
  fmt::print(
      "| form | outside [V, 1] | falls with albedo | with V | off at 0, 1 | finite |\n"
      "| --- | --- | --- | --- | --- | --- |\n");
  expect_escape_stable_in_every_type("g = ao", VisibilityAoModel{});
  expect_escape_stable_in_every_type("g of V and n.z", VisibilityNormalModel{});
  for (const double m : {0.0, 0.382, 1.0})
    expect_escape_stable_in_every_type("g of ao and m", MeanEscapeModel{m});
  // Every map of fits/ whose m is known.
  for (const FitFile& file : stored_fits())
    for (const MapEscape& map : file.escapes)
      if (map.mean_escape) expect_all_passed(check_model(MeanEscapeModel{*map.mean_escape}, 1e-6));
}

TEST(Stability, BounceMapHoldsOnTheWholeSquareOfBytes) {
  fmt::print(
      "| form | outside [V, 1] | falls with albedo | with bounce | with V, albedo <= r | off at 0, r, 1 | "
      "finite |\n"
      "| --- | --- | --- | --- | --- | --- | --- |\n");
  expect_bounce_map_stable<double>("double", 0x1p-52);
  expect_bounce_map_stable<float>("float", 0x1p-23);
#ifdef __FLT16_MANT_DIG__
  __extension__ using Half = _Float16;
  expect_bounce_map_stable<Half>("half", 0x1p-10);
#endif
  expect_all_passed(check_model(BounceMapModel{}, 1e-6));
}

// Beyond r the curve through a fixed E_r is lower where V is higher: V = 0 needs all of its E_r from bounces.
TEST(Stability, BounceMapFallsWithVisibilityBeyondItsAlbedo) {
  const BounceMapModel model{0.9};
  EXPECT_LT(model.total(0.1, 0.5, 0.8), model.total(0.2, 0.5, 0.8));
  EXPECT_NEAR(model.total(0.1, 0.5, 0.9), model.total(0.2, 0.5, 0.9), 1e-15);
  EXPECT_GT(model.total(0.1, 0.5, 0.95), model.total(0.2, 0.5, 0.95));
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
