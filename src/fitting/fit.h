// What a fit is: input points, and what came out. No Ceres here.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "curves/curves.h"

namespace hemibake {

// Where on the AO axis the mean of a bin stands.
enum class Abscissa {
  center,     // the middle of the bin
  published,  // (j + 1)/(bins − 1) for bin j from 0: what the constants of 2018 were fitted with, one bin too
              // far
};

// How much a bin counts.
enum class Weights {
  none,            // every bin the same
  count,           // by its number of texels
  standard_error,  // by the inverse variance of its mean, count/stddev²
};

struct CurvePoint {
  double ao = 0;      // abscissa α
  double value = 0;   // E_b/π at albedo 1
  double weight = 1;  // relative, above 0; the weights of a fit have mean 1
  double albedo = 1;  // ρ, where the value depends on it
};

// The points of one bounce, in bin order; empty bins are left out, with Weights::standard_error also bins of
// fewer than two texels. bounce: 0..bounce_count − 1. Throws InputError where the weights need counts that
// `curves` lacks.
std::vector<CurvePoint> curve_points(const Curves& curves, int bounce, Abscissa abscissa, Weights weights);

// E/π of all bounces of one bin at albedo `albedo` (0..1): Σ ρᵇ E_b/π, the bounces after the last stored one
// as a geometric series with the ratio of the last two, or with a lower one where that would add up to more
// than π at albedo 1.
double total_over_pi(const CurveBin& bin, double albedo);

// The points (α, ρ, total_over_pi), for each usable bin one after another for each of `albedos`. The spread
// of a total is at most the sum of the spreads of its bounces: that stands for it with
// Weights::standard_error.
std::vector<CurvePoint> total_points(const Curves& curves, std::span<const double> albedos, Abscissa abscissa,
                                     Weights weights);

// The same with the cosine-weighted visible fraction E₀/π of each bin in place of α.
std::vector<CurvePoint> visibility_points(const Curves& curves, std::span<const double> albedos,
                                          Weights weights);

struct FitParameter {
  std::string name;
  double value = 0;
  // Square root of the diagonal of the covariance; none where the parameter sits on its bound.
  std::optional<double> standard_error;
};

struct Fit {
  std::string model;
  std::string formula;
  std::vector<FitParameter> parameters;
  // Parameters × parameters, rows one after another: s²(JᵀWJ)⁻¹ with s² = Σ w r²/(points − parameters). True
  // to the spread of the parameters where the errors of the points are independent with variances
  // proportional to 1/w.
  std::vector<double> covariance;
  double rms = 0;              // of the residuals, unweighted, in E/π
  double max_error = 0;        // largest residual, in E/π
  int points = 0;              // residuals
  std::optional<double> aicc;  // Akaike's criterion, small-sample form; none where points <= parameters + 2
  Abscissa abscissa = Abscissa::center;
  Weights weights = Weights::none;
};

// A fit and the name it has in FIT.json.
struct NamedFit {
  std::string name;
  Fit fit;
};

// Value of the parameter called `name`; a bug if there is none.
double parameter_value(const Fit& fit, const std::string& name);

std::string to_string(Abscissa abscissa);  // center, published
std::string to_string(Weights weights);    // none, count, stderr

// The inverses. Throw InputError for any other text.
Abscissa abscissa_from_string(const std::string& text);
Weights weights_from_string(const std::string& text);

}  // namespace hemibake
