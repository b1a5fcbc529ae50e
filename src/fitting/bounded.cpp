#include "fitting/bounded.h"

#include <limits>

#include "curves/closed_forms.h"
#include "fitting/least_squares.h"

namespace hemibake {

Fit fit_bounded_direct(std::span<const CurvePoint> points) {
  Formula formula{
      "bounded F0", "a*(1 + (1-a)*(k0 + (k1-k0)*a^2))", {{"k0", 0, 1}, {"k1", 0, 1}}, {{0.7, 0.7}}};
  return fit_formula<2>(formula, points, [](const auto* p, const CurvePoint& point) {
    return bounded_direct_factor(point.ao, p[0], p[1]);
  });
}

Fit fit_bounded_tau(std::span<const CurvePoint> points, int albedo_count, const Fit& direct) {
  Formula formula{"bounded tau", "1 - F0^n", {{"n", 0.05, 4}}, {{0.25}, {0.5}, {1.0}, {2.0}}, albedo_count};
  const double k0 = parameter_value(direct, "k0");
  const double k1 = parameter_value(direct, "k1");
  return fit_formula<1>(formula, points, [k0, k1]<class T>(const T* p, const CurvePoint& point) {
    const double factor = bounded_direct_factor(point.ao, k0, k1);
    return total_factor(T(factor), T(bounded_blocked_factor(point.ao, k0, k1)), escape_share(factor, p[0]),
                        point.albedo, std::numeric_limits<double>::min());
  });
}

std::vector<double> fit_albedos() { return {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}; }

}  // namespace hemibake
