// Checks that a fitted model is fit for a shader.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace hemibake {

// Evaluates F₀, τ and the total in float over 1001 α × 21 ρ, ends included: finite, in 0..1, total 1 at ρ
// = 1.
template <class Model>
Checks check_model(const Model& model, double tolerance) {
  constexpr int kSteps = 1000, kAlbedoSteps = 20;
  double direct = 0, ratio = 0, total = 0, whole = 0;
  const auto widen = [](double& worst, float value, float low, float high) {
    const double away = std::isfinite(value) ? std::max({0.0f, low - value, value - high}) : HUGE_VAL;
    worst = std::max(worst, away);
  };
  for (int i = 0; i <= kSteps; ++i) {
    const float ao = static_cast<float>(i) / kSteps;
    widen(direct, model.template direct<float>(ao), 0, 1);
    widen(ratio, model.template bounce_ratio<float>(ao), 0, 1);
    for (int j = 0; j <= kAlbedoSteps; ++j)
      widen(total, model.template total<float>(ao, static_cast<float>(j) / kAlbedoSteps), 0, 1);
    if (ao > 0) widen(whole, model.template total<float>(ao, 1.0f), 1, 1);
  }
  return {{"F0 outside 0..1, worst", direct, 0, tolerance, ""},
          {"tau outside 0..1, worst", ratio, 0, tolerance, ""},
          {"total outside 0..1 for ao, albedo in 0..1, worst", total, 0, tolerance, ""},
          {"total at albedo 1 off 1, worst", whole, 0, tolerance, ""}};
}

}  // namespace hemibake
