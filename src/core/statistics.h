// Sums and moments in double precision, in the order given.
#pragma once

#include <cstddef>
#include <span>

namespace hemibake {

// Mean and spread of a sample (Welford 1962: no cancellation for values far from zero).
struct Moments {
  size_t count = 0;
  double mean = 0;
  double sum_squared_deviations = 0;

  void add(double value) {
    ++count;
    const double delta = value - mean;
    mean += delta / static_cast<double>(count);
    sum_squared_deviations += delta * (value - mean);
  }
  // Standard deviation of the values themselves (divides by count; 0 for none).
  double stddev() const;
};

// Returns the mean; of floats that of the values that are not NaN, which holes of a bake have.
double mean(std::span<const float> values);
double mean(std::span<const double> values);

// Root of the mean squared difference; both the same length.
double rms_difference(std::span<const float> a, std::span<const float> b);

}  // namespace hemibake
