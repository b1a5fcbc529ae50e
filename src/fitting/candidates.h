// Compares models: each is fitted to one set of curves and measured on any.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "curves/curves.h"

namespace hemibake {

// Predicts E/π from α (ao), E₀/π (visibility; only Jimenez' cubic uses it) and ρ (albedo), each 0..1.
using Prediction = std::function<double(double ao, double visibility, double albedo)>;

struct Candidate {
  const char* name;
  const char* formula;
  int parameters;  // fitted ones
  Prediction (*fit)(const Curves& curves);
};

// Returns the candidates in the order of the table in fits/README.md.
const std::vector<Candidate>& candidates();

// Holds errors of E/π over the populated bins × the albedos 0, 0.1, … 1.
struct Score {
  double rms = 0;
  double max_error = 0;
};

Score score_prediction(const Prediction& prediction, const Curves& curves);

struct Comparison {
  std::vector<Score> own;     // of each set of curves, fitted to it
  std::vector<Score> others;  // of each, fitted to the bins of all the other sets; empty for a single set
  // Σ of the small-sample Akaike criterion of the fits in `own`, a bin being one observation; only
  // differences mean anything, lower is better. None where a set has too few bins.
  std::optional<double> aicc;
};

// Fits `candidate` to each of `sets` (at least one) and to all the others together. Throws what the fits
// throw.
Comparison compare_candidate(const Candidate& candidate, const std::vector<Curves>& sets);

}  // namespace hemibake
