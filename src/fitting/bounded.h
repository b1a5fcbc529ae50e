// Fits the bounded model (model/closed_forms.h) with every parameter where the model is monotone in 0..1.
#pragma once

#include <span>
#include <vector>

#include "fitting/fit.h"

namespace hemibake {

// Fits F₀ = α(1 + (1−α)(k0 + (k1−k0)α²)) to points of bounce 0. Parameters k0, k1, each in −1..1.
Fit fit_bounded_direct(std::span<const CurvePoint> points, const Starts& starts = {});

// Fits τ = 1 − q(1 − d(1−F₀)/(1+3F₀)) to total_points. Parameters q, 0.001..1, and d, 0..0.999.
// albedo_count: points per bin, the same for every bin.
// direct: the fit of F₀; the standard errors of q and d take it as exact.
Fit fit_bounded_tau(std::span<const CurvePoint> points, int albedo_count, const Fit& direct,
                    const Starts& starts = {});

// Returns the albedos that totals are fitted at, 0.1, 0.2, … 0.9: at 0 only F₀ matters, at 1 every bounded
// model gives 1.
std::vector<double> fit_albedos();

}  // namespace hemibake
