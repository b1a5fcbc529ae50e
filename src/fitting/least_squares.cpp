#include "fitting/least_squares.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/portable_math.h"
#include "fitting/evaluation.h"

namespace hemibake {
namespace {

// Starts of least cost that are followed: the best one is not always in the right valley.
constexpr size_t kStartsTried = 3;

// Least ratio of the singular values of the column-scaled Jacobian for determined parameters: its square, the
// condition of JᵀJ, reaches the rounding of a double.
constexpr double kSmallestConditioning = 1e-7;

// Least effect (rms, E/π) on the curve of changing a determined parameter by its own size or by 1: the
// rounding of the values.
constexpr double kSmallestEffect = 1e-12;

// Returns the starts of least cost, best first.
std::vector<std::vector<double>> best_starts(const Formula& formula, const ceres::CostFunction& cost) {
  std::vector<std::pair<double, std::vector<double>>> ranked;
  for (const std::vector<double>& start : formula.starts) {
    const Evaluation at = evaluate(cost, start);
    const double sum = at.residuals.squaredNorm();
    if (std::isfinite(sum) && at.jacobian.allFinite()) ranked.emplace_back(sum, start);
  }
  if (ranked.empty())
    throw CheckError(fmt::format("fit of {}: no start gives finite residuals", formula.model));
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::vector<double>> best;
  for (size_t i = 0; i < std::min(ranked.size(), kStartsTried); ++i) best.push_back(ranked[i].second);
  return best;
}

// Returns the lowest minimum that the best starts lead to. An unconverged one takes part: lower than all
// others, it proves that they are not the minimum.
Minimum lowest_minimum(const Formula& formula, ceres::CostFunction& cost) {
  Minimum lowest;
  for (const std::vector<double>& start : best_starts(formula, cost)) {
    Minimum found = minimize_within(formula.parameters, cost, start);
    if (found.cost < lowest.cost || lowest.parameters.empty()) lowest = std::move(found);
  }
  if (!lowest.failure.empty())
    throw CheckError(fmt::format("fit of {} did not converge: {}", formula.model, lowest.failure));
  return lowest;
}

// Returns s²(JᵀJ)⁻¹ over the free parameters; rows and columns of those on a bound are 0.
Matrix covariance(const Formula& formula, const Evaluation& at, const std::vector<double>& parameters,
                  const std::vector<Eigen::Index>& free, double observations) {
  const Eigen::Index all = at.jacobian.cols();
  Matrix result = Matrix::Zero(all, all);
  const Eigen::Index count = static_cast<Eigen::Index>(free.size());
  if (count == 0) return result;
  const Eigen::MatrixXd j = at.jacobian(Eigen::all, free);
  const Eigen::VectorXd length = j.colwise().norm().transpose();
  for (Eigen::Index c = 0; c < count; ++c) {
    const size_t p = static_cast<size_t>(free[c]);
    const double effect = length[c] * std::max(1.0, std::abs(parameters[p]));
    if (effect > kSmallestEffect * std::sqrt(static_cast<double>(j.rows()))) continue;
    throw CheckError(
        fmt::format("fit of {}: the points do not determine {}", formula.model, formula.parameters[p].name));
  }
  const Eigen::MatrixXd scaled = j * length.cwiseInverse().asDiagonal();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
  const Eigen::VectorXd& singular = svd.singularValues();
  if (singular[count - 1] < kSmallestConditioning * singular[0]) {
    throw CheckError(fmt::format(
        "fit of {}: the covariance is singular, the points do not determine every parameter", formula.model));
  }
  const double variance = at.residuals.squaredNorm() / (observations - static_cast<double>(count));
  const Eigen::MatrixXd half =
      length.cwiseInverse().asDiagonal() * svd.matrixV() * singular.cwiseInverse().asDiagonal();
  result(free, free) = variance * half * half.transpose();
  return result;
}

// Returns Akaike's criterion of weighted points: the likelihood of a point of weight w has the factor √w.
// observations: count once each, however many points they have.
std::optional<double> weighted_aic(const Evaluation& at, std::span<const CurvePoint> points,
                                   double observations) {
  const double count = static_cast<double>(points.size());
  double log_weights = 0;
  for (const CurvePoint& point : points) log_weights += PortableMath<double>::log(point.weight);
  std::optional<double> aic = small_sample_aic(at.residuals.squaredNorm() / count, observations,
                                               static_cast<int>(at.jacobian.cols()));
  if (aic) *aic -= log_weights * observations / count;
  return aic;
}

}  // namespace

std::optional<double> small_sample_aic(double mean_square, double observations, int parameters) {
  const double k = parameters + 1;
  if (observations - k - 1 <= 0 || mean_square <= 0) return std::nullopt;
  return observations * PortableMath<double>::log(mean_square) + 2 * k +
         2 * k * (k + 1) / (observations - k - 1);
}

Fit minimize(const Formula& formula, std::span<const CurvePoint> points,
             std::unique_ptr<ceres::CostFunction> cost) {
  const size_t count = formula.parameters.size();
  const size_t observations = points.size() / static_cast<size_t>(formula.points_per_observation);
  if (observations <= count) {
    throw InputError(fmt::format("{} usable bins, expected at least {} for the {} parameters of {}",
                                 observations, count + 1, count, formula.model));
  }
  const Minimum minimum = lowest_minimum(formula, *cost);
  const Evaluation at = evaluate(*cost, minimum.parameters);
  std::vector<Eigen::Index> free;
  for (size_t p = 0; p < count; ++p)
    if (!minimum.held[p]) free.push_back(static_cast<Eigen::Index>(p));
  const Matrix spread = covariance(formula, at, minimum.parameters, free, static_cast<double>(observations));

  Fit fit;
  fit.model = formula.model;
  fit.formula = formula.text;
  for (size_t p = 0; p < count; ++p)
    fit.parameters.push_back(
        {formula.parameters[p].name, minimum.parameters[p], std::nullopt, minimum.held[p]});
  for (const Eigen::Index p : free)
    fit.parameters[static_cast<size_t>(p)].standard_error = std::sqrt(spread(p, p));
  fit.covariance.assign(spread.data(), spread.data() + spread.size());
  double sum = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const double error = at.residuals[static_cast<Eigen::Index>(i)] / std::sqrt(points[i].weight);
    sum += error * error;
    fit.max_error = std::max(fit.max_error, std::abs(error));
  }
  fit.rms = std::sqrt(sum / static_cast<double>(points.size()));
  fit.points = static_cast<int>(points.size());
  fit.aicc = weighted_aic(at, points, static_cast<double>(observations));
  return fit;
}

}  // namespace hemibake
