// Fits the formulas of the notes of 2018 and Jimenez' cubic (model/closed_forms.h).
#pragma once

#include <span>

#include "fitting/fit.h"

namespace hemibake {

// Fits F₀ = α(1 + k(1−α)^e) to points of bounce 0. Parameters k, e (e >= 0).
Fit fit_direct(std::span<const CurvePoint> points, const Starts& starts = {});

// Fits F₁ = A α(1−α)^1.5 exp(−B α^¼) to points of bounce 1. Parameters A, B.
Fit fit_first_bounce(std::span<const CurvePoint> points, const Starts& starts = {});

// Fits F_b = A α(1−α)^1.5 exp(−B α^C) to points of bounce b >= 1. Parameters A, B, C, 0.02..5.
Fit fit_bounce(std::span<const CurvePoint> points, int bounce, const Starts& starts = {});

// Fits Jimenez' cubic ((aV + b)V + c)V, a = a1 ρ + a0 and so on. Parameters a1, a0, b1, b0, c1, c0,
// unbounded. points: `ao` is V, either E₀/π as in their paper or α. albedo_count: points per bin.
Fit fit_jimenez(std::span<const CurvePoint> points, int albedo_count, const Starts& starts = {});

}  // namespace hemibake
