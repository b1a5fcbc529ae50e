#include "core/statistics.h"

#include <cmath>

#include "core/error.h"

namespace hemibake {
double Moments::stddev() const {
  return count == 0 ? 0.0 : std::sqrt(sum_squared_deviations / static_cast<double>(count));
}

double mean(std::span<const float> values) {
  double sum = 0;
  size_t count = 0;
  for (const float value : values) {
    if (std::isnan(value)) continue;
    sum += static_cast<double>(value);
    ++count;
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}
double mean(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double rms_difference(std::span<const float> a, std::span<const float> b) {
  expect_equal(a.size(), b.size(), "length of the second sample");
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    sum += d * d;
  }
  return a.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace hemibake
