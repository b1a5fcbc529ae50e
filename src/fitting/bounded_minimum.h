// Minimises a sum of squares within bounds: an active set around Ceres, which alone stops at the first bound
// that it meets. Only for this folder's .cpp files.
#pragma once

#include <ceres/ceres.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace hemibake {

struct ParameterRange {
  std::string name;
  double lower = -HUGE_VAL;
  double upper = HUGE_VAL;
};

struct Minimum {
  std::vector<double> parameters;
  std::vector<bool> held;  // of each parameter: it is on its bound, and the cost falls only beyond it
  double cost = HUGE_VAL;  // ½ Σ residual²
  std::string failure;     // why it is no minimum; empty: it is one
};

// Returns the minimum of ½ Σ residual² that `start` leads to. The Karush-Kuhn-Tucker conditions hold there:
// the gradient of what is free is 0 to kGradientTolerance, that of what is held points outward. Method: holds
// what stands on a bound with an outward gradient, solves the others, releases what has an inward gradient,
// and repeats until nothing changes (Nocedal and Wright, "Numerical Optimization", 2006, section 16.5). cost:
// one parameter block of ranges.size(); start: within the ranges.
Minimum minimize_within(std::span<const ParameterRange> ranges, ceres::CostFunction& cost,
                        std::vector<double> start);

// Largest cosine between the residuals and a free column of the Jacobian at a minimum. Fits of curves reach
// 10⁻⁷; one that creeps along an endless valley stays above 10⁻³.
inline constexpr double kGradientTolerance = 1e-5;

}  // namespace hemibake
