// Fits of the published formulas (model/closed_forms.h).
#pragma once

#include <span>

#include "fitting/fit.h"

namespace hemibake {

// F₀ = α(1 + k(1−α)^e) to points of bounce 0. Parameters k, e (e >= 0).
Fit fit_direct(std::span<const CurvePoint> points);

// F₁ = A α(1−α)^1.5 exp(−B α^¼) to points of bounce 1. Parameters A, B.
Fit fit_first_bounce(std::span<const CurvePoint> points);

// F_b = A α(1−α)^1.5 exp(−B α^C) to points of bounce b >= 1. Parameters A, B, C (C in 0.02..5).
Fit fit_bounce(std::span<const CurvePoint> points, int bounce);

// Jimenez' cubic ((aV + b)V + c)V with a, b, c linear in the albedo (model/closed_forms.h) to points whose
// `ao` is the visibility V: E₀/π, as they have it, or α. Parameters a1, a0, b1, b0, c1, c0 (a = a1 ρ + a0).
// No bounds. albedo_count: points per bin.
Fit fit_jimenez(std::span<const CurvePoint> points, int albedo_count);

}  // namespace hemibake
