#include "fitting/bounded.h"

#include "fitting/least_squares.h"
#include "model/closed_forms.h"

namespace hemibake {

Fit fit_bounded_direct(std::span<const CurvePoint> points, const Starts& starts) {
  Formula formula{
      "bounded F0", "a*(1 + (1-a)*(k0 + (k1-k0)*a^2))", {{"k0", -1, 1}, {"k1", -1, 1}}, {{0.5, 0.9}}};
  if (!starts.empty()) formula.starts = starts;
  return fit_formula<2>(formula, points, [](const auto* p, const CurvePoint& point) {
    return bounded_direct_factor(point.ao, p[0], p[1]);
  });
}

Fit fit_bounded_tau(std::span<const CurvePoint> points, int albedo_count, const Fit& direct,
                    const Starts& starts) {
  Formula formula{
      "bounded tau", "1 - q*(1 - d*(1-F0)/(1+3*F0))", {{"q", 0.001, 1}, {"d", 0, 0.999}}, {}, albedo_count};
  for (const double q : {0.2, 0.5, 0.8}) {
    for (const double d : {0.3, 0.8}) formula.starts.push_back({q, d});
  }
  const double k0 = parameter_value(direct, "k0");
  const double k1 = parameter_value(direct, "k1");
  if (!starts.empty()) formula.starts = starts;
  return fit_formula<2>(formula, points, [k0, k1](const auto* p, const CurvePoint& point) {
    const double factor = bounded_direct_factor(point.ao, k0, k1);
    const double blocked = bounded_blocked_factor(point.ao, k0, k1);
    return total_factor(factor, blocked, bounded_escape_share(factor, p[0] * (1.0 - p[1]), p[0]),
                        point.albedo);
  });
}

std::vector<double> fit_albedos() { return {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9}; }

}  // namespace hemibake
