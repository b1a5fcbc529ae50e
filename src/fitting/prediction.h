// Measures any model against curves.
#pragma once

#include <functional>

#include "curves/curves.h"

namespace hemibake {

// Predicts E/π from α (ao), V = E₀/π (visibility) and ρ (albedo), each 0..1. Over curves of V only models
// that do not use `ao` mean anything.
using Prediction = std::function<double(double ao, double visibility, double albedo)>;

// Holds errors of E/π over the populated bins × the albedos 0, 0.1, … 1.
struct Score {
  double rms = 0;
  double max_error = 0;
};

// Returns the errors of a prediction at the bins' centres and mean V.
Score score_prediction(const Prediction& prediction, const Curves& curves);

}  // namespace hemibake
