// Lists the models that curves can be fitted with, by name.
#pragma once

#include <string>
#include <vector>

#include "fitting/fit.h"

namespace hemibake {

struct FitModel {
  const char* name;
  const char* summary;
  std::vector<NamedFit> (*fit)(const Curves& curves, Abscissa abscissa, Weights weights);
};

// Returns the table of models, in the order of --help. Fits of each:
// published: F0 (k, e) and F1 (A, B). bounded: bounded_F0 (k0, k1) and bounded_tau (q, d).
// bounces: bounce_01, bounce_02, … (A, B, C). jimenez: jimenez (V = E₀/π) and jimenez_ao (V = α).
const std::vector<FitModel>& fit_models();

// Fits the model called `name`. Throws InputError where the name is unknown or the curves do not suffice,
// CheckError where a fit fails.
std::vector<NamedFit> fit_model(const std::string& name, const Curves& curves, Abscissa abscissa,
                                Weights weights);

// Returns a warning line for every parameter on a bound or no larger than its error.
std::vector<std::string> fit_warnings(const std::vector<NamedFit>& fits);

}  // namespace hemibake
