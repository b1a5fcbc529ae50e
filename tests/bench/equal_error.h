// CPU seconds at one error, from measurements at several settings.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace hemibake {

struct Measured {
  double cpu_seconds;
  double error;  // rms over texels
};

// CPU seconds where the error is `wanted`, on the power law through the two nearest measurements; they come
// with falling errors, two at least.
inline double seconds_at_error(const std::vector<Measured>& runs, double wanted) {
  size_t i = 1;
  while (i + 1 < runs.size() && runs[i].error > wanted) ++i;
  const Measured &a = runs[i - 1], &b = runs[i];
  const double exponent = std::log(b.cpu_seconds / a.cpu_seconds) / std::log(b.error / a.error);
  return b.cpu_seconds * std::pow(wanted / b.error, exponent);
}

}  // namespace hemibake
