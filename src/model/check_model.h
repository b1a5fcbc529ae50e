// Checks that a fitted model is fit for a shader.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "model/model.h"

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

// Evaluates all bounces in float over 101 × 101 inputs × 21 ρ, ends included: finite, in [V, 1], rising with
// ρ, V at ρ = 0, 1 at ρ = 1. total(visibility, second, albedo): E/π. Called by the checks below.
template <class Total>
Checks check_total(Total total, double tolerance) {
  constexpr int kSteps = 100, kAlbedoSteps = 20;
  double range = 0, fall = 0, ends = 0;
  const auto widen = [](double& worst, float value, float low, float high) {
    const double away = std::isfinite(value) ? std::max({0.0f, low - value, value - high}) : HUGE_VAL;
    worst = std::max(worst, away);
  };
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const float visibility = static_cast<float>(i) / kSteps, second = static_cast<float>(j) / kSteps;
      float before = 0;
      for (int k = 0; k <= kAlbedoSteps; ++k) {
        const float e = total(visibility, second, static_cast<float>(k) / kAlbedoSteps);
        widen(range, e, visibility, 1);
        widen(fall, e, before, 1);
        if (k == 0) widen(ends, e, visibility, visibility);
        if (k == kAlbedoSteps) widen(ends, e, 1, 1);
        before = e;
      }
    }
  return {{"total outside [V, 1], worst", range, 0, tolerance, ""},
          {"total falls with albedo, worst", fall, 0, tolerance, ""},
          {"off V at albedo 0, off 1 at albedo 1, worst", ends, 0, tolerance, ""}};
}

inline Checks check_model(const VisibilityModel& model, double tolerance) {
  return check_total([&](float visibility, float, float albedo) { return model.total(visibility, albedo); },
                     tolerance);
}

// Checks a model of V and a second input.
template <class Model>
requires requires(const Model& model) { model.total(1.0f, 1.0f, 1.0f); }
Checks check_model(const Model& model, double tolerance) {
  return check_total(
      [&](float visibility, float second, float albedo) { return model.total(visibility, second, albedo); },
      tolerance);
}

}  // namespace hemibake
