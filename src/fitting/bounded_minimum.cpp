#include "fitting/bounded_minimum.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>

#include "fitting/evaluation.h"

namespace hemibake {
namespace {

constexpr int kMaxSteps = 1000;
// Rounds of holding and releasing. Each lowers the cost, and N parameters have at most 3^N sets of bounds.
constexpr int kMaxRounds = 100;
// Cosine below which a gradient has no sign but rounding's.
constexpr double kZeroGradient = 1e-12;
// Root mean square of residuals that are all rounding: their gradient means nothing.
constexpr double kRounding = 1e-9;

// Minimises over the parameters that are not held. Returns why it failed; empty: converged.
std::string solve_free(std::span<const ParameterRange> ranges, ceres::CostFunction& cost, Minimum& at) {
  std::vector<int> held;
  for (size_t p = 0; p < ranges.size(); ++p)
    if (at.held[p]) held.push_back(static_cast<int>(p));
  if (held.size() == ranges.size()) return "";

  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  problem.AddResidualBlock(&cost, nullptr, at.parameters.data());
  if (!held.empty())
    problem.SetManifold(at.parameters.data(),
                        new ceres::SubsetManifold(static_cast<int>(ranges.size()), held));
  for (size_t p = 0; p < ranges.size(); ++p) {
    const int index = static_cast<int>(p);
    if (std::isfinite(ranges[p].lower))
      problem.SetParameterLowerBound(at.parameters.data(), index, ranges[p].lower);
    if (std::isfinite(ranges[p].upper))
      problem.SetParameterUpperBound(at.parameters.data(), index, ranges[p].upper);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  options.max_num_iterations = kMaxSteps;
  options.function_tolerance = 1e-15;  // as far as doubles go: the constants are compared to 10⁻⁶ and better
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-11;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.termination_type == ceres::CONVERGENCE ? "" : summary.message;
}

// Returns the cosines between the residuals and the columns of the Jacobian, the gradient without its units.
Eigen::VectorXd gradient_cosines(const Evaluation& at) {
  const double length = at.residuals.norm();
  Eigen::VectorXd cosines = Eigen::VectorXd::Zero(at.jacobian.cols());
  for (Eigen::Index p = 0; p < cosines.size(); ++p) {
    const double column = at.jacobian.col(p).norm();
    if (length > 0 && column > 0) cosines[p] = at.jacobian.col(p).dot(at.residuals) / (column * length);
  }
  return cosines;
}

// Returns whether the gradient of what is free is 0: Ceres also stops where a valley is too flat to follow.
bool is_stationary(const Evaluation& at, const Eigen::VectorXd& gradient, const std::vector<bool>& held) {
  if (at.residuals.norm() <= kRounding * std::sqrt(static_cast<double>(at.residuals.size()))) return true;
  for (size_t p = 0; p < held.size(); ++p)
    if (!held[p] && !(std::abs(gradient[static_cast<Eigen::Index>(p)]) <= kGradientTolerance)) return false;
  return true;
}

// Returns what to hold: the parameters on a bound whose cost does not fall inward.
std::vector<bool> outward(std::span<const ParameterRange> ranges, const std::vector<double>& parameters,
                          const Eigen::VectorXd& gradient) {
  std::vector<bool> held(ranges.size());
  for (size_t p = 0; p < ranges.size(); ++p) {
    const double slope = gradient[static_cast<Eigen::Index>(p)];
    held[p] = (parameters[p] <= ranges[p].lower && slope >= -kZeroGradient) ||
              (parameters[p] >= ranges[p].upper && slope <= kZeroGradient);
  }
  return held;
}

}  // namespace

Minimum minimize_within(std::span<const ParameterRange> ranges, ceres::CostFunction& cost,
                        std::vector<double> start) {
  Minimum at{std::move(start), std::vector<bool>(ranges.size(), false), HUGE_VAL, ""};
  for (int round = 0; round < kMaxRounds; ++round) {
    at.failure = solve_free(ranges, cost, at);
    const Evaluation values = evaluate(cost, at.parameters);
    at.cost = 0.5 * values.residuals.squaredNorm();
    if (!at.failure.empty()) return at;
    const Eigen::VectorXd gradient = gradient_cosines(values);
    const std::vector<bool> held = outward(ranges, at.parameters, gradient);
    if (held == at.held) {
      if (!is_stationary(values, gradient, held)) at.failure = "the gradient is not 0 where it stops";
      return at;
    }
    at.held = held;
  }
  at.failure = fmt::format("no set of bounds to hold after {} rounds", kMaxRounds);
  return at;
}

}  // namespace hemibake
