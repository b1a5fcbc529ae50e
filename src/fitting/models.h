// The models that curves can be fitted with, by name.
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

// published: F0 (k, e) and F1 (A, B). bounded: bounded_F0 (k0, k1) and bounded_tau (n).
const std::vector<FitModel>& fit_models();

// All fits of the model called `name`. Throws InputError where the name is unknown or the curves do not
// suffice, CheckError where a fit fails.
std::vector<NamedFit> fit_model(const std::string& name, const Curves& curves, Abscissa abscissa,
                                Weights weights);

// What a reader of these fits should be warned of, one line each: parameters on a bound, or no larger than
// their error.
std::vector<std::string> fit_warnings(const std::vector<NamedFit>& fits);

}  // namespace hemibake
