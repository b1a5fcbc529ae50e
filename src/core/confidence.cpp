#include "core/confidence.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace hemibake {

double normal_quantile(double confidence) {
  // Newton on erfc(z/√2) = 1 − confidence from the left of the root, where it is convex: no overshoot.
  const double tail = 1 - confidence;
  double z = 0;
  for (int i = 0; i < 100; ++i) {
    const double density = std::sqrt(2 / std::numbers::pi) * std::exp(-z * z / 2);
    const double step = (std::erfc(z / std::numbers::sqrt2) - tail) / density;
    z += step;
    if (std::abs(step) < 1e-14) break;
  }
  return z;
}

double student_quantile(double confidence, double degrees_of_freedom) {
  if (!(degrees_of_freedom >= 1)) return std::numeric_limits<double>::infinity();
  const double z = normal_quantile(confidence), v = degrees_of_freedom;
  // One and two degrees of freedom have closed forms, above them Abramowitz & Stegun, "Handbook of
  // Mathematical Functions", 1964, 26.7.5 (Cornish-Fisher expansion).
  if (v < 2) return std::tan(std::numbers::pi / 2 * confidence);
  if (v < 3) return confidence * std::sqrt(2 / (1 - confidence * confidence));
  const double s = z * z;
  const double g1 = (s + 1) / 4;
  const double g2 = ((5 * s + 16) * s + 3) / 96;
  const double g3 = (((3 * s + 19) * s + 17) * s - 15) / 384;
  const double g4 = ((((79 * s + 776) * s + 1482) * s - 1920) * s - 945) / 92160;
  return z * (1 + (g1 + (g2 + (g3 + g4 / v) / v) / v) / v);
}

}  // namespace hemibake
