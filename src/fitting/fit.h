// Declares the points that a fit takes and the result that it gives. No Ceres here.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "curves/curves.h"

namespace hemibake {

// Selects the place of a bin on the AO axis.
enum class Abscissa {
  kCenter,      // middle of the bin
  kMayaux2018,  // (j + 1)/(bins − 1) for bin j from 0: that of the constants of 2018, one bin too far
  kVisibility,  // V, the mean E₀/π of its texels, whatever the curves are over
};

// Selects the weight of a bin.
enum class Weights {
  kNone,           // the same for every bin
  kCount,          // its number of texels
  kStandardError,  // the inverse variance of its mean, count/stddev²
};

struct CurvePoint {
  double ao = 0;          // abscissa α
  double value = 0;       // E_b/π at albedo 1
  double weight = 1;      // relative, above 0; the weights of a fit have mean 1
  double albedo = 1;      // ρ, where the value depends on it
  double visibility = 0;  // V = E₀/π of the bin, where the value depends on it
};

// Returns the points of one bounce in bin order, without empty bins.
// bounce: 0..bounce_count − 1.
// weights: with kStandardError, bins of fewer than two texels are left out too.
// Throws InputError where the weights need counts that `curves` lacks.
std::vector<CurvePoint> curve_points(const Curves& curves, int bounce, Abscissa abscissa, Weights weights);

// Returns the points (α, ρ, total_over_pi), bin by bin and within a bin in the order of `albedos`.
// albedos: ρ, each 0..1.
// weights: with kStandardError, the spread of a total is its upper bound, the sum of its bounces' spreads.
std::vector<CurvePoint> total_points(const Curves& curves, std::span<const double> albedos, Abscissa abscissa,
                                     Weights weights);

struct FitParameter {
  std::string name;
  double value = 0;
  // Square root of the covariance's diagonal; none for a parameter on its bound. Where others are on theirs,
  // it holds for them staying there.
  std::optional<double> standard_error;
  bool on_bound = false;  // the residuals fall only beyond the end of its range
};

// Sets of parameters that a fit begins from.
using Starts = std::vector<std::vector<double>>;

struct Fit {
  std::string model;
  std::string formula;
  std::vector<FitParameter> parameters;
  // s²(JᵀWJ)⁻¹ with s² = Σ w r²/(points − parameters); parameters × parameters, row by row. Holds for
  // independent errors of variances proportional to 1/w.
  std::vector<double> covariance;
  double rms = 0;              // of the residuals, unweighted, in E/π
  double max_error = 0;        // largest residual, in E/π
  int points = 0;              // residuals
  std::optional<double> aicc;  // Akaike's criterion, small-sample form; none where points <= parameters + 2
  Abscissa abscissa = Abscissa::kCenter;
  Weights weights = Weights::kNone;
};

// Pairs a fit with its name in FIT.json.
struct NamedFit {
  std::string name;
  Fit fit;
};

// Returns the value of the parameter called `name`. Throws std::logic_error where there is none.
double parameter_value(const Fit& fit, const std::string& name);

std::string to_string(Abscissa abscissa);  // center, published, visibility
std::string to_string(Weights weights);    // none, count, stderr

// Parse the texts above. Throw InputError for any other.
Abscissa abscissa_from_string(const std::string& text);
Weights weights_from_string(const std::string& text);

}  // namespace hemibake
