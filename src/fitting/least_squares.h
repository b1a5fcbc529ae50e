// Fits a formula to curve points by bounded nonlinear least squares (Ceres). Only for this folder's .cpp
// files.
#pragma once

#include <ceres/ceres.h>

#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "fitting/bounded_minimum.h"
#include "fitting/fit.h"
#include "fitting/portable_jet.h"

namespace hemibake {

// Describes a formula to the minimiser; a cost function beside it gives its values.
struct Formula {
  std::string model;  // as in FIT.json
  std::string text;   // the formula for a human
  std::vector<ParameterRange> parameters;
  Starts starts;                   // those of least cost are followed
  int points_per_observation = 1;  // points that share one error: a bin at several albedos
};

// Gives Ceres the residuals √w·(formula − value) of `points`.
// value: callable as T value(const T* parameters, const CurvePoint&) for T double and a Jet; N: parameters.
template <int N, class Value>
class CurveResiduals {
 public:
  CurveResiduals(std::span<const CurvePoint> points, Value value) : points_(points), value_(value) {}

  template <class T>
  bool operator()(const T* parameters, T* residuals) const {
    for (size_t i = 0; i < points_.size(); ++i) {
      residuals[i] = std::sqrt(points_[i].weight) * (value_(parameters, points_[i]) - points_[i].value);
    }
    return true;
  }

 private:
  std::span<const CurvePoint> points_;
  Value value_;
};

// Minimises ½ Σ residual² within the bounds.
// cost: the residuals above, over `points`.
// Throws InputError for fewer observations than parameters + 1, CheckError where the minimisation does not
// converge or the points do not determine every parameter.
Fit minimize(const Formula& formula, std::span<const CurvePoint> points,
             std::unique_ptr<ceres::CostFunction> cost);

template <int N, class Value>
Fit fit_formula(const Formula& formula, std::span<const CurvePoint> points, Value value) {
  using Residuals = CurveResiduals<N, Value>;
  using Cost = ceres::AutoDiffCostFunction<Residuals, ceres::DYNAMIC, N>;
  return minimize(formula, points,
                  std::make_unique<Cost>(new Residuals(points, value), static_cast<int>(points.size())));
}

// Returns Akaike's criterion for least squares, n ln(mean square) + 2K + 2K(K+1)/(n−K−1), K = parameters + 1
// (Burnham & Anderson, "Model Selection and Multimodel Inference", 2002, eq. 7.3). None where n is too small.
std::optional<double> small_sample_aic(double mean_square, double observations, int parameters);

// Returns the factor s that minimises Σ w (s·shape(α) − value)²; 0 where the shape vanishes at every point.
template <class Shape>
double best_scale(std::span<const CurvePoint> points, Shape shape) {
  double product = 0, square = 0;
  for (const CurvePoint& point : points) {
    const double s = shape(point.ao);
    product += point.weight * s * point.value;
    square += point.weight * s * s;
  }
  return square > 0 ? product / square : 0;
}

}  // namespace hemibake
