// What a set of measurements says: which of them are worth their time, and how fast error falls.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace hemibake {

struct CostAndError {
  double cpu_seconds;
  double error;
};

// Indices of the Pareto front: those that no other beats in both, by rising cost. Of equals the first.
std::vector<size_t> pareto_front(std::span<const CostAndError> runs);

// log y = intercept + slope · log x by least squares.
struct PowerLaw {
  double slope = 0, intercept = 0;
  double slope_error = 0;  // standard error; 0 where two points fit exactly
  size_t points = 0;       // below 2: nothing else is meaningful

  double at(double x) const;
};

// Points where x or y is not above 0 do not count.
PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y);

}  // namespace hemibake
