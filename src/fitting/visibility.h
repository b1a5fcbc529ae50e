// Fits the escape share of the visibility models (model/model.h): E/π = 1 − (1−V)(1−ρ)/(1 − ρ + ρg).
#pragma once

#include <span>

#include "fitting/fit.h"

namespace hemibake {

// Fits g = dark + (open−dark)V to totals. Parameters dark, open, each 0..1. points: their `visibility` is V.
// albedo_count: points per bin, the same for every bin.
Fit fit_visibility(std::span<const CurvePoint> points, int albedo_count, const Starts& starts = {});

// Fits g = dark + (open−dark)α to totals, V being given. Parameters dark, open, each 0..1. points: their `ao`
// is α, their `visibility` V. albedo_count: as above.
Fit fit_visibility_ao(std::span<const CurvePoint> points, int albedo_count, const Starts& starts = {});

}  // namespace hemibake
