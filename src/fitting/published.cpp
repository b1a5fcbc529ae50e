#include "fitting/published.h"

#include "curves/closed_forms.h"
#include "fitting/least_squares.h"

namespace hemibake {

Fit fit_direct(std::span<const CurvePoint> points) {
  Formula formula{"published F0", "a*(1 + k*(1-a)^e)", {{"k"}, {"e", 0}}, {}};
  for (const double e : {0.25, 0.75, 1.0, 1.5, 3.0}) {
    for (const double k : {-0.5, 0.25, 0.5, 1.0, 2.0}) formula.starts.push_back({k, e});
  }
  return fit_formula<2>(formula, points, [](const auto* p, const CurvePoint& point) {
    return direct_factor(point.ao, p[0], p[1]);
  });
}

Fit fit_first_bounce(std::span<const CurvePoint> points) {
  Formula formula{"published F1", "A*a*(1-a)^1.5*exp(-B*a^0.25)", {{"A"}, {"B"}}, {}};
  for (const double b : {-2.0, 0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0}) {
    const double a = best_scale(points, [b](double ao) { return first_bounce_factor(ao, 1.0, b); });
    formula.starts.push_back({a, b});
  }
  return fit_formula<2>(formula, points, [](const auto* p, const CurvePoint& point) {
    return first_bounce_factor(point.ao, p[0], p[1]);
  });
}

}  // namespace hemibake
