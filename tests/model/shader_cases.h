// Models whose exported text the tests run, one grid of inputs for every language, and what the library
// gives.
#pragma once

#include <cmath>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "model/shader_text.h"

namespace hemibake {

struct ShaderCase {
  std::string name;  // also the prefix of its text
  AnyModel model;
};

inline std::vector<ShaderCase> shader_cases() {
  return {{"soft_", BoundedModel{0.0697, 1, 0.5065, 0.8318}},
          {"deep_", BoundedModel{0.421, 1, 0.458, 0.999}},       // on the bound of d: 1 − d must not cancel
          {"darkest_", BoundedModel{0.421, 1, 1e-6, 0.999999}},  // below half's smallest number
          {"notes_", GuardedModel{}},
          {"plain_", VisibilityModel{0, 1}},
          {"closed_", VisibilityModel{0, 0}},
          {"fitted_", VisibilityModel{0.03, 0.83}},
          {"normal_", VisibilityNormalModel{}},
          {"escape_", VisibilityAoModel{}},
          {"escape_fitted_", VisibilityAoModel{0.05, 0.9}},
          {"mean_", MeanEscapeModel{0.375}},
          {"map_", BounceMapModel{0.9}},
          {"cubic_", JimenezModel{}}};
}

// Inputs: x and y in 32nds, the albedo in 16ths but .999999 for 15/16: both ends, exact in float.
constexpr int kInputSteps = 33, kAlbedoSteps = 17;
constexpr size_t kGridSize = size_t{kInputSteps} * kInputSteps * kAlbedoSteps;
constexpr const char* kAlmostOne = "0.999999";

// Tells the models of two inputs from those of one.
template <class Model>
concept OfTwoInputs = requires(const Model& model) {
  model.total(1.0, 1.0, 1.0);
};

inline bool has_two_inputs(const AnyModel& model) {
  return std::visit([]<class Model>(const Model&) { return OfTwoInputs<Model>; }, model);
}

// Writes the call of a case's function of `x`, `y` and `rgb`. pair: the text of (x, y) as a pair.
inline std::string call_of(const ShaderCase& shader, const std::string& pair) {
  if (std::holds_alternative<BounceMapModel>(shader.model))
    return shader.name + "multi_bounce(" + pair + ", rgb)";
  return shader.name + "multi_bounce_irradiance(x, " + (has_two_inputs(shader.model) ? "y, " : "") + "rgb)";
}

// Returns the library's total. x: visibility or AO. y: the second input, where there is one.
inline double total_of(const AnyModel& model, double x, double y, double albedo) {
  return std::visit(
      [&]<class Model>(const Model& m) {
        if constexpr (OfTwoInputs<Model>)
          return m.total(x, y, albedo);
        else
          return m.total(x, albedo);
      },
      model);
}

// Returns the largest difference of three channels at each grid point, x outermost, albedo innermost: the
// albedo, half of it, and 1. values: `stride` a point. A NaN is the largest.
inline double largest_difference(const AnyModel& model, std::span<const float> values, size_t stride) {
  double largest = 0;
  size_t at = 0;
  for (int i = 0; i < kInputSteps; ++i)
    for (int j = 0; j < kInputSteps; ++j)
      for (int k = 0; k < kAlbedoSteps; ++k, at += stride) {
        const double x = i / 32.0, y = j / 32.0;
        const double albedo = k == 15 ? static_cast<double>(0.999999F) : k / 16.0;
        const double expected[] = {total_of(model, x, y, albedo), total_of(model, x, y, 0.5 * albedo),
                                   total_of(model, x, y, 1)};
        for (size_t c = 0; c < 3; ++c) {
          const double difference = std::abs(static_cast<double>(values[at + c]) - expected[c]);
          largest = difference <= largest ? largest : difference;
        }
      }
  return largest;
}

// A float holds 6·10⁻⁸ of 1, a dozen operations lose 10⁻⁶ at most. pow is good to some 10⁻⁶ on a GPU.
inline double tolerance_of(const AnyModel& model) {
  return std::holds_alternative<GuardedModel>(model) ? 5e-6 : 1e-6;
}

}  // namespace hemibake
