// The Pareto front of cost and error, and the power law by which error falls.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hemibake {

struct CostAndError {
  double cpu_seconds;
  double error;
};

// Returns the indices of the runs that no other beats in both, by rising cost; among equals the first.
std::vector<size_t> pareto_front(std::span<const CostAndError> runs);

// log y = constant + slope · log x.
struct PowerLaw {
  double slope = 0;
  double slope_error = 0;  // standard error; 0 where two points fit exactly
  size_t points = 0;       // below 2: nothing else is meaningful
};

// Fits by least squares of log y; leaves out points where x or y is not above 0.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace hemibake
