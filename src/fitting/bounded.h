// Fits of the bounded model (model/closed_forms.h): every parameter stays where the model is within 0..1 and
// monotone.
#pragma once

#include <span>
#include <vector>

#include "fitting/fit.h"

namespace hemibake {

// F₀ = α(1 + (1−α)(k0 + (k1−k0)α²)) to points of bounce 0. Parameters k0, k1, each in −1..1.
Fit fit_bounded_direct(std::span<const CurvePoint> points);

// τ = 1 − q(1 − d(1−F₀)/(1+3F₀)) to total_points (every bin at the same number of albedos), F₀ as fitted in
// `direct`: the standard errors are for that F₀. Parameters q, 0.001..1, and d, 0..0.999. albedo_count:
// points per bin.
Fit fit_bounded_tau(std::span<const CurvePoint> points, int albedo_count, const Fit& direct);

// The albedos that fits of totals use: 0.1, 0.2, … 0.9. At 0 only F₀ matters, at 1 every bounded model gives
// exactly 1.
std::vector<double> fit_albedos();

}  // namespace hemibake
