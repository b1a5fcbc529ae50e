// Lists the models that curves can be fitted with, by name.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "fitting/fit.h"
#include "fitting/prediction.h"

namespace hemibake {

struct FitModel {
  const char* name;
  const char* summary;
  bool needs_ao;  // its curves must be over α
  std::vector<NamedFit> (*fit)(const Curves& curves, Abscissa abscissa, Weights weights);
  // Returns E/π of the fits as shaders evaluate them; null where the model has no total.
  Prediction (*predict)(std::span<const NamedFit> fits);
};

// Returns the table of models, in the order of --help. Fits of each:
// published: F0 (k, e) and F1 (A, B). bounded: bounded_F0 (k0, k1) and bounded_tau (q, d).
// visibility: visibility (dark, open). visibility-ao: visibility_ao (dark, open).
// bounces: bounce_01, bounce_02, … (A, B, C). jimenez: jimenez (V = E₀/π) and, of curves over α, jimenez_ao
// (V = α).
const std::vector<FitModel>& fit_models();

// Returns the model called `name`. Throws InputError where there is none.
const FitModel& fit_model_called(const std::string& name);

// Returns the names of the models that are fitted unless others are asked for: published, bounded, visibility
// and visibility-ao, of curves over V only visibility.
std::vector<std::string> default_fit_models(CurveIndex index);

// Fits the model called `name`. Throws InputError where the name is unknown or the curves do not suffice,
// CheckError where a fit fails.
// abscissa: kCenter or kMayaux2018; of fits that stand at V it is kVisibility whatever is asked for.
std::vector<NamedFit> fit_model(const std::string& name, const Curves& curves, Abscissa abscissa,
                                Weights weights);

// Returns a warning line for every parameter on a bound or no larger than its error.
std::vector<std::string> fit_warnings(const std::vector<NamedFit>& fits);

}  // namespace hemibake
