#include "curves/check_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "transport/series.h"

namespace hemibake {
namespace {

// Returns the distance of a value from low..high; NaN stays NaN and fails.
double outside(double value, double low, double high) {
  if (std::isnan(value)) return value;
  return std::max({0.0, low - value, value - high});
}

// Keeps the worst bin of one kind of violation.
struct Worst {
  double value = 0;
  size_t bin = 0;

  void offer(double candidate, size_t index) {
    if (std::isnan(candidate) || candidate > value) *this = {candidate, index};
  }
  Check check(const char* quantity, double tolerance) const {
    return {quantity, value, 0, tolerance, value > 0 ? fmt::format("bin {}", bin) : ""};
  }
};

}  // namespace

Checks check_curves(const Curves& curves, double tolerance, bool require_whole_energy) {
  Worst mean, direct, range, excess;
  const bool over_ao = curves.index == CurveIndex::kAo;
  double sum_furthest_from_1 = 1;
  size_t furthest_bin = 0;
  for (size_t b = 0; b < curves.bins.size(); ++b) {
    const CurveBin& bin = curves.bins[b];
    if (bin.count <= 0) continue;
    if (curves.has_counts) mean.offer(outside(bin.mean, bin.low, bin.high), b);
    // Both bounds rise with the index, so the ends of the bin bound the mean of its texels.
    const double low = over_ao ? bin.low * bin.low : bin.low;
    const double high = over_ao ? bin.high * (2 - bin.high) : bin.high;
    direct.offer(outside(bin_visibility(bin), low, high), b);
    const auto over_pi = [&](size_t bounce) { return bin.bounces[bounce].mean / kPi; };
    for (size_t k = 0; k < bin.bounces.size(); ++k) range.offer(outside(over_pi(k), 0, 1), b);
    const double sum = sum_bounces(bin.bounces.size(), over_pi, 1);
    excess.offer(std::isnan(sum) ? sum : std::max(0.0, sum - 1), b);
    if (!(std::abs(sum - 1) <= std::abs(sum_furthest_from_1 - 1))) {
      sum_furthest_from_1 = sum;
      furthest_bin = b;
    }
  }
  const double judged = require_whole_energy ? tolerance : std::numeric_limits<double>::infinity();
  return {
      mean.check(over_ao ? "mean ao outside its bin, worst" : "mean visibility outside its bin, worst", 1e-6),
      direct.check(over_ao ? "E0/pi outside ao^2 .. ao(2-ao), worst bin" : "E0/pi outside its bin, worst",
                   tolerance),
      range.check("irradiance/pi outside 0..1, worst bin", tolerance),
      excess.check("energy sum/pi above 1, worst bin", tolerance),
      {"energy sum/pi, worst bin", sum_furthest_from_1, 1, judged, fmt::format("bin {}", furthest_bin)}};
}

}  // namespace hemibake
