// Compares models: each is fitted to one set of curves and measured on any.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "curves/curves.h"
#include "fitting/prediction.h"

namespace hemibake {

struct Candidate {
  const char* name;
  const char* formula;
  int parameters;  // fitted ones
  bool needs_ao;   // its curves must be over α
  Prediction (*fit)(const Curves& curves);
};

// Returns the candidates in the order of the table in fits/README.md.
const std::vector<Candidate>& candidates();

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
