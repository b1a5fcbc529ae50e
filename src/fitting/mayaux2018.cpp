#include "fitting/mayaux2018.h"

#include <fmt/format.h>

#include "fitting/least_squares.h"
#include "model/closed_forms.h"

namespace hemibake {

Fit fit_direct(std::span<const CurvePoint> points, const Starts& starts) {
  Formula formula{"published F0", "a*(1 + k*(1-a)^e)", {{"k"}, {"e", 0}}, {}};
  for (const double e : {0.25, 0.75, 1.0, 1.5, 3.0}) {
    for (const double k : {-0.5, 0.25, 0.5, 1.0, 2.0}) formula.starts.push_back({k, e});
  }
  if (!starts.empty()) formula.starts = starts;
  return fit_formula<2>(formula, points, [](const auto* p, const CurvePoint& point) {
    return direct_factor(point.ao, p[0], p[1]);
  });
}

Fit fit_first_bounce(std::span<const CurvePoint> points, const Starts& starts) {
  Formula formula{"published F1", "A*a*(1-a)^1.5*exp(-B*a^0.25)", {{"A"}, {"B"}}, {}};
  for (const double b : {-2.0, 0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0}) {
    const double a = best_scale(points, [b](double ao) { return first_bounce_factor(ao, 1.0, b); });
    formula.starts.push_back({a, b});
  }
  if (!starts.empty()) formula.starts = starts;
  return fit_formula<2>(formula, points, [](const auto* p, const CurvePoint& point) {
    return first_bounce_factor(point.ao, p[0], p[1]);
  });
}

Fit fit_bounce(std::span<const CurvePoint> points, int bounce, const Starts& starts) {
  Formula formula{
      fmt::format("bounce {}", bounce), "A*a*(1-a)^1.5*exp(-B*a^C)", {{"A"}, {"B"}, {"C", 0.02, 5}}, {}};
  for (const double c : {0.1, 0.2, 0.35, 0.5, 0.7, 1.0}) {
    for (const double b : {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0}) {
      const double a = best_scale(points, [b, c](double ao) { return bounce_factor(ao, 1.0, b, c); });
      formula.starts.push_back({a, b, c});
    }
  }
  if (!starts.empty()) formula.starts = starts;
  return fit_formula<3>(formula, points, [](const auto* p, const CurvePoint& point) {
    return bounce_factor(point.ao, p[0], p[1], p[2]);
  });
}

Fit fit_jimenez(std::span<const CurvePoint> points, int albedo_count, const Starts& starts) {
  Formula formula{"Jimenez cubic",
                  "(((a1*r + a0)*V + b1*r + b0)*V + c1*r + c0)*V",
                  {{"a1"}, {"a0"}, {"b1"}, {"b0"}, {"c1"}, {"c0"}},
                  {{0, 0, 0, 0, 0, 1}},
                  albedo_count};
  if (!starts.empty()) formula.starts = starts;
  return fit_formula<6>(formula, points, [](const auto* p, const CurvePoint& point) {
    return jimenez_cubic(point.ao, point.albedo, p);
  });
}

}  // namespace hemibake
