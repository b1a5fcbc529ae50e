// Evaluates residuals and their Jacobian. Only for this folder's .cpp files.
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Dense>
#include <vector>

namespace hemibake {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Evaluation {
  Eigen::VectorXd residuals;
  Matrix jacobian;  // residuals × parameters
};

// Returns both at `parameters`. cost: one parameter block of that size.
inline Evaluation evaluate(const ceres::CostFunction& cost, const std::vector<double>& parameters) {
  Evaluation result{Eigen::VectorXd(cost.num_residuals()), Matrix(cost.num_residuals(), parameters.size())};
  const double* blocks[] = {parameters.data()};
  double* jacobians[] = {result.jacobian.data()};
  cost.Evaluate(blocks, result.residuals.data(), jacobians);
  return result;
}

}  // namespace hemibake
