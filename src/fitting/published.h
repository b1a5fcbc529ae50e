// Fits of the published formulas (curves/closed_forms.h).
#pragma once

#include <span>

#include "fitting/fit.h"

namespace hemibake {

// F₀ = α(1 + k(1−α)^e) to points of bounce 0. Parameters k, e (e >= 0).
Fit fit_direct(std::span<const CurvePoint> points);

// F₁ = A α(1−α)^1.5 exp(−B α^¼) to points of bounce 1. Parameters A, B.
Fit fit_first_bounce(std::span<const CurvePoint> points);

}  // namespace hemibake
