#include "fitting/models.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "fitting/bounded.h"
#include "fitting/mayaux2018.h"
#include "fitting/visibility.h"
#include "model/model.h"

namespace hemibake {
namespace {

void expect_bounces(const Curves& curves, int count, const char* model) {
  if (curves.bounce_count >= count) return;
  throw InputError(fmt::format("{} curve(s) per bin, expected at least {} for the model {}",
                               curves.bounce_count, count, model));
}

std::vector<NamedFit> fit_mayaux2018(const Curves& curves, Abscissa abscissa, Weights weights) {
  expect_bounces(curves, 2, "published");
  return {{"F0", fit_direct(curve_points(curves, 0, abscissa, weights))},
          {"F1", fit_first_bounce(curve_points(curves, 1, abscissa, weights))}};
}

std::vector<NamedFit> fit_bounded(const Curves& curves, Abscissa abscissa, Weights weights) {
  expect_bounces(curves, 2, "bounded");
  const std::vector<double> albedos = fit_albedos();
  const Fit direct = fit_bounded_direct(curve_points(curves, 0, abscissa, weights));
  return {{"bounded_F0", direct},
          {"bounded_tau", fit_bounded_tau(total_points(curves, albedos, abscissa, weights),
                                          static_cast<int>(albedos.size()), direct)}};
}

std::vector<NamedFit> fit_bounces(const Curves& curves, Abscissa abscissa, Weights weights) {
  expect_bounces(curves, 2, "bounces");
  std::vector<NamedFit> fits;
  for (int b = 1; b < curves.bounce_count; ++b) {
    fits.push_back(
        {fmt::format("bounce_{:02}", b), fit_bounce(curve_points(curves, b, abscissa, weights), b)});
  }
  return fits;
}

// Marks a fit whose points stand at V.
Fit at_visibility(Fit fit) {
  fit.abscissa = Abscissa::kVisibility;
  return fit;
}

std::vector<NamedFit> fit_jimenez_twice(const Curves& curves, Abscissa abscissa, Weights weights) {
  expect_bounces(curves, 2, "jimenez");
  const std::vector<double> albedos = fit_albedos();
  const int count = static_cast<int>(albedos.size());
  std::vector<NamedFit> fits = {
      {"jimenez",
       at_visibility(fit_jimenez(total_points(curves, albedos, Abscissa::kVisibility, weights), count))}};
  if (curves.index == CurveIndex::kAo)
    fits.push_back({"jimenez_ao", fit_jimenez(total_points(curves, albedos, abscissa, weights), count)});
  return fits;
}

std::vector<NamedFit> fit_over_visibility(const Curves& curves, Abscissa, Weights weights) {
  expect_bounces(curves, 2, "visibility");
  const std::vector<double> albedos = fit_albedos();
  return {{"visibility",
           at_visibility(fit_visibility(total_points(curves, albedos, Abscissa::kVisibility, weights),
                                        static_cast<int>(albedos.size())))}};
}

std::vector<NamedFit> fit_over_visibility_and_ao(const Curves& curves, Abscissa abscissa, Weights weights) {
  expect_bounces(curves, 2, "visibility-ao");
  const std::vector<double> albedos = fit_albedos();
  return {{"visibility_ao", fit_visibility_ao(total_points(curves, albedos, abscissa, weights),
                                              static_cast<int>(albedos.size()))}};
}

double value_in(std::span<const NamedFit> fits, size_t fit, const char* name) {
  return parameter_value(fits[fit].fit, name);
}

Prediction predict_mayaux2018(std::span<const NamedFit> fits) {
  const GuardedModel model{
      {value_in(fits, 0, "k"), value_in(fits, 0, "e"), value_in(fits, 1, "A"), value_in(fits, 1, "B")}};
  return [model](double ao, double, double albedo) { return model.total(ao, albedo); };
}

Prediction predict_bounded(std::span<const NamedFit> fits) {
  const BoundedModel model{value_in(fits, 0, "k0"), value_in(fits, 0, "k1"), value_in(fits, 1, "q"),
                           value_in(fits, 1, "d")};
  return [model](double ao, double, double albedo) { return model.total(ao, albedo); };
}

Prediction predict_visibility(std::span<const NamedFit> fits) {
  const VisibilityModel model{value_in(fits, 0, "dark"), value_in(fits, 0, "open")};
  return [model](double, double visibility, double albedo) { return model.total(visibility, albedo); };
}

Prediction predict_visibility_ao(std::span<const NamedFit> fits) {
  const VisibilityAoModel model{value_in(fits, 0, "dark"), value_in(fits, 0, "open")};
  return [model](double ao, double visibility, double albedo) { return model.total(visibility, ao, albedo); };
}

Prediction predict_jimenez(std::span<const NamedFit> fits) {
  JimenezModel model;
  for (size_t i = 0; i < model.parameters.size(); ++i) model.parameters[i] = fits[0].fit.parameters[i].value;
  return [model](double, double visibility, double albedo) { return model.total(visibility, albedo); };
}

}  // namespace

const std::vector<FitModel>& fit_models() {
  static const std::vector<FitModel> models = {
      {"published", "F0 and F1 of the notes of 2018", true, fit_mayaux2018, predict_mayaux2018},
      {"bounded", "F0 and tau that stay within 0..1", true, fit_bounded, predict_bounded},
      {"visibility", "all bounces from V, the cosine-weighted visible fraction", false, fit_over_visibility,
       predict_visibility},
      {"visibility-ao", "all bounces from V and the uniform visible fraction", true,
       fit_over_visibility_and_ao, predict_visibility_ao},
      {"bounces", "each bounce on its own", true, fit_bounces, nullptr},
      {"jimenez", "their cubic over the cosine-weighted and over the uniform visible fraction", false,
       fit_jimenez_twice, predict_jimenez},
  };
  return models;
}

const FitModel& fit_model_called(const std::string& name) {
  for (const FitModel& model : fit_models())
    if (name == model.name) return model;
  throw InputError(fmt::format("no model '{}', expected one of fit_models", name));
}

std::vector<std::string> default_fit_models(CurveIndex index) {
  if (index == CurveIndex::kVisibility) return {"visibility"};
  return {"published", "bounded", "visibility", "visibility-ao"};
}

std::vector<NamedFit> fit_model(const std::string& name, const Curves& curves, Abscissa abscissa,
                                Weights weights) {
  const FitModel& model = fit_model_called(name);
  if (model.needs_ao && curves.index != CurveIndex::kAo)
    throw InputError(fmt::format("curves over visibility, expected curves over ao for the model {}", name));
  std::vector<NamedFit> fits = model.fit(curves, abscissa, weights);
  for (NamedFit& named : fits) {
    if (named.fit.abscissa != Abscissa::kVisibility) named.fit.abscissa = abscissa;
    named.fit.weights = weights;
  }
  return fits;
}

std::vector<std::string> fit_warnings(const std::vector<NamedFit>& fits) {
  std::vector<std::string> warnings;
  for (const auto& [name, fit] : fits) {
    for (const FitParameter& parameter : fit.parameters) {
      if (parameter.on_bound) {
        warnings.push_back(fmt::format(
            "{}: {} = {:.6g} is on its bound and has no standard error; the other errors hold for it there",
            name, parameter.name, parameter.value));
      } else if (!parameter.standard_error) {
        continue;
      } else if (*parameter.standard_error > std::abs(parameter.value)) {
        warnings.push_back(fmt::format("{}: {} = {:.6g} ± {:.2g} is not told from 0", name, parameter.name,
                                       parameter.value, *parameter.standard_error));
      }
    }
  }
  return warnings;
}

}  // namespace hemibake
