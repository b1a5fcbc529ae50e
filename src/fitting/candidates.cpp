#include "fitting/candidates.h"

#include <algorithm>
#include <cmath>

#include "fitting/bounded.h"
#include "fitting/least_squares.h"
#include "fitting/mayaux2018.h"
#include "fitting/models.h"
#include "model/closed_forms.h"
#include "model/model.h"

namespace hemibake {
namespace {

std::vector<CurvePoint> points_of(const Curves& curves, int bounce) {
  return curve_points(curves, bounce, Abscissa::kCenter, Weights::kNone);
}

std::vector<CurvePoint> totals_of(const Curves& curves, Abscissa abscissa = Abscissa::kCenter) {
  return total_points(curves, fit_albedos(), abscissa, Weights::kNone);
}

// Holds F₀ (factor) and 1 − F₀ (blocked) of one α.
struct Direct {
  double ao = 0, factor = 0, blocked = 0;
};

// Evaluates F₀ of the bounded model.
struct DirectModel {
  double k0 = 0, k1 = 0;

  Direct operator()(double ao) const {
    return {ao, bounded_direct_factor(ao, k0, k1), bounded_blocked_factor(ao, k0, k1)};
  }
};

// Fits F₀ = α(1 + k(1−α)): s = k everywhere.
DirectModel fit_line(const Curves& curves) {
  const Formula formula{"line F0", "", {{"k", -1, 1}}, {{0.5}}};
  const Fit fit = fit_formula<1>(formula, points_of(curves, 0), [](const auto* p, const CurvePoint& point) {
    return bounded_direct_factor(point.ao, p[0], p[0]);
  });
  return {parameter_value(fit, "k"), parameter_value(fit, "k")};
}

// Fits k0 with k1 = 1: nearly open ground sees its sky overhead.
DirectModel fit_overhead(const Curves& curves) {
  const Formula formula{"overhead F0", "", {{"k0", -1, 1}}, {{0.5}}};
  const Fit fit = fit_formula<1>(formula, points_of(curves, 0), [](const auto* p, const CurvePoint& point) {
    using T = std::decay_t<decltype(p[0])>;
    return bounded_direct_factor(point.ao, p[0], T(1));
  });
  return {parameter_value(fit, "k0"), 1};
}

DirectModel fit_both(const Curves& curves) {
  const Fit fit = fit_bounded_direct(points_of(curves, 0));
  return {parameter_value(fit, "k0"), parameter_value(fit, "k1")};
}

// Fits a formula of 1 − τ to the totals and joins it to a fitted F₀.
// escape: callable as escape(p, Direct) with N parameters p in the ranges `parameters`.
template <int N, class Escape>
Prediction fit_escape(const Curves& curves, DirectModel direct, const std::vector<ParameterRange>& parameters,
                      const std::vector<std::vector<double>>& starts, Escape escape) {
  const std::vector<CurvePoint> points = totals_of(curves);
  const Formula formula{"candidate", "", parameters, starts, static_cast<int>(fit_albedos().size())};
  const Fit fit = fit_formula<N>(formula, points, [=](const auto* p, const CurvePoint& point) {
    const Direct at = direct(point.ao);
    return total_factor(at.factor, at.blocked, escape(p, at), point.albedo);
  });
  std::array<double, N> found;
  for (size_t i = 0; i < N; ++i) found[i] = fit.parameters[i].value;
  return [=](double ao, double, double albedo) {
    const Direct at = direct(ao);
    return total_factor(at.factor, at.blocked, escape(found.data(), at), albedo);
  };
}

template <class T>
T power(double base, const T& exponent) {
  return PortableMath<T>::pow(base, exponent);
}

Prediction with_power(const Curves& curves, DirectModel direct) {
  return fit_escape<1>(curves, direct, {{"n", 0.02, 5}}, {{0.3}, {1.0}},
                       [](const auto* p, const Direct& at) { return power(at.factor, p[0]); });
}

Prediction with_scaled_power(const Curves& curves, DirectModel direct) {
  return fit_escape<2>(curves, direct, {{"q", 0.001, 1}, {"n", 0.02, 5}}, {{0.5, 0.3}, {0.8, 1.0}},
                       [](const auto* p, const Direct& at) { return p[0] * power(at.factor, p[1]); });
}

Prediction with_straight(const Curves& curves, DirectModel direct) {
  return fit_escape<2>(curves, direct, {{"q", 0.001, 1}, {"d", 0, 0.999}}, {{0.5, 0.5}},
                       [](const auto* p, const Direct& at) { return p[0] * (1.0 - p[1] * (1 - at.ao)); });
}

Prediction with_square(const Curves& curves, DirectModel direct) {
  return fit_escape<2>(
      curves, direct, {{"q", 0.001, 1}, {"d", 0, 0.999}}, {{0.5, 0.5}},
      [](const auto* p, const Direct& at) { return p[0] * (1.0 - p[1] * (at.blocked * at.blocked)); });
}

Prediction with_quotient(const Curves& curves, DirectModel direct) {
  return fit_escape<2>(curves, direct, {{"q", 0.001, 1}, {"d", 0, 0.999}}, {{0.5, 0.5}},
                       [](const auto* p, const Direct& at) {
                         return bounded_escape_share(at.factor, p[0] * (1.0 - p[1]), p[0]);
                       });
}

Mayaux2018Model fit_formulas(const Curves& curves) {
  const Fit direct = fit_direct(points_of(curves, 0));
  const Fit first = fit_first_bounce(points_of(curves, 1));
  return {parameter_value(direct, "k"), parameter_value(direct, "e"), parameter_value(first, "A"),
          parameter_value(first, "B")};
}

template <class Model>
Prediction total_of(const Model& model) {
  return [model](double ao, double, double albedo) { return model.total(ao, albedo); };
}

Prediction jimenez_of(const JimenezModel& model, bool over_ao) {
  return [model, over_ao](double ao, double visibility, double albedo) {
    return model.total(over_ao ? ao : visibility, albedo);
  };
}

Prediction jimenez_refit(const Curves& curves, bool over_ao) {
  const Fit fit = fit_jimenez(totals_of(curves, over_ao ? Abscissa::kCenter : Abscissa::kVisibility),
                              static_cast<int>(fit_albedos().size()));
  JimenezModel model;
  for (size_t i = 0; i < 6; ++i) model.parameters[i] = fit.parameters[i].value;
  return jimenez_of(model, over_ao);
}

Prediction escape_from_visibility(const VisibilityModel& model) {
  return [model](double, double visibility, double albedo) { return model.total(visibility, albedo); };
}

Prediction escape_from_ao(const VisibilityAoModel& model) {
  return [model](double ao, double visibility, double albedo) { return model.total(visibility, ao, albedo); };
}

// Fits the model of fit_models called `name`.
Prediction refit(const char* name, const Curves& curves) {
  return fit_model_called(name).predict(fit_model(name, curves, Abscissa::kCenter, Weights::kNone));
}

double populated_bins(const Curves& curves) {
  return static_cast<double>(std::count_if(curves.bins.begin(), curves.bins.end(),
                                           [](const CurveBin& bin) { return bin.count > 0; }));
}

Curves all_but(std::vector<Curves> sets, size_t left_out) {
  sets.erase(sets.begin() + static_cast<ptrdiff_t>(left_out));
  return pool_curves(sets);
}

}  // namespace

const std::vector<Candidate>& candidates() {
  static const std::vector<Candidate> all = {
      {"published", "k, e; A, B", 4, true,
       [](const Curves& curves) { return total_of(fit_formulas(curves)); }},
      {"published, cut", "the same, F0 <= 1 and 0 <= tau <= 1", 4, true,
       [](const Curves& curves) { return total_of(GuardedModel{fit_formulas(curves)}); }},
      {"line, power", "s = k; 1-tau = F0^n", 2, true,
       [](const Curves& curves) { return with_power(curves, fit_line(curves)); }},
      {"bounded, power", "s = k0..k1; 1-tau = F0^n", 3, true,
       [](const Curves& curves) { return with_power(curves, fit_both(curves)); }},
      {"bounded, q power", "s = k0..k1; 1-tau = q F0^n", 4, true,
       [](const Curves& curves) { return with_scaled_power(curves, fit_both(curves)); }},
      {"bounded, straight", "s = k0..k1; 1-tau = q(1 - d(1-a))", 4, true,
       [](const Curves& curves) { return with_straight(curves, fit_both(curves)); }},
      {"bounded, square", "s = k0..k1; 1-tau = q(1 - d(1-F0)^2)", 4, true,
       [](const Curves& curves) { return with_square(curves, fit_both(curves)); }},
      {"overhead", "s = k0..1; 1-tau = q(1 - d(1-F0)/(1+3F0))", 3, true,
       [](const Curves& curves) { return with_quotient(curves, fit_overhead(curves)); }},
      {"bounded", "s = k0..k1; 1-tau = q(1 - d(1-F0)/(1+3F0))", 4, true,
       [](const Curves& curves) { return with_quotient(curves, fit_both(curves)); }},
      {"Jimenez 2016", "their constants, V = E0/pi", 0, false,
       [](const Curves&) { return jimenez_of({}, false); }},
      {"Jimenez 2016, ao", "their constants, V = a", 0, true,
       [](const Curves&) { return jimenez_of({}, true); }},
      {"Jimenez, refit", "V = E0/pi", 6, false,
       [](const Curves& curves) { return jimenez_refit(curves, false); }},
      {"Jimenez, refit, ao", "V = a", 6, true,
       [](const Curves& curves) { return jimenez_refit(curves, true); }},
      {"g = V", "1-tau = V", 0, false, [](const Curves&) { return escape_from_visibility({}); }},
      {"visibility", "1-tau = dark..open over V", 2, false,
       [](const Curves& curves) { return refit("visibility", curves); }},
      {"g = a", "1-tau = a, of V", 0, true, [](const Curves&) { return escape_from_ao({}); }},
      {"visibility-ao", "1-tau = dark..open over a, of V", 2, true,
       [](const Curves& curves) { return refit("visibility-ao", curves); }},
  };
  return all;
}

Comparison compare_candidate(const Candidate& candidate, const std::vector<Curves>& sets) {
  Comparison comparison;
  comparison.aicc = 0;
  for (size_t i = 0; i < sets.size(); ++i) {
    comparison.own.push_back(score_prediction(candidate.fit(sets[i]), sets[i]));
    const double mean_square = comparison.own[i].rms * comparison.own[i].rms;
    const auto aicc = small_sample_aic(mean_square, populated_bins(sets[i]), candidate.parameters);
    comparison.aicc = comparison.aicc && aicc ? std::optional(*comparison.aicc + *aicc) : std::nullopt;
    if (sets.size() > 1) {
      comparison.others.push_back(score_prediction(candidate.fit(all_but(sets, i)), sets[i]));
    }
  }
  return comparison;
}

}  // namespace hemibake
