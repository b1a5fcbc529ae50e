#include "fitting/visibility.h"

#include "fitting/least_squares.h"
#include "model/closed_forms.h"

namespace hemibake {
namespace {

// input: the AO of a point that g is linear in.
Fit fit_escape(const char* model, const char* text, std::span<const CurvePoint> points, int albedo_count,
               const Starts& starts, double CurvePoint::*input) {
  Formula formula{model, text, {{"dark", 0, 1}, {"open", 0, 1}}, starts, albedo_count};
  if (starts.empty()) formula.starts = {{0.05, 0.9}, {0.5, 0.5}, {0.2, 1}};
  return fit_formula<2>(formula, points, [input](const auto* p, const CurvePoint& point) {
    using T = std::decay_t<decltype(p[0])>;
    const T escape = p[0] + (p[1] - p[0]) * (point.*input);
    return escape_irradiance(point.visibility, escape, point.albedo);
  });
}

}  // namespace

Fit fit_visibility(std::span<const CurvePoint> points, int albedo_count, const Starts& starts) {
  return fit_escape("visibility", "1 - (1-V)*(1-r)/(1 - r + r*(dark + (open-dark)*V))", points, albedo_count,
                    starts, &CurvePoint::visibility);
}

Fit fit_visibility_ao(std::span<const CurvePoint> points, int albedo_count, const Starts& starts) {
  return fit_escape("visibility and ao", "1 - (1-V)*(1-r)/(1 - r + r*(dark + (open-dark)*a))", points,
                    albedo_count, starts, &CurvePoint::ao);
}

}  // namespace hemibake
