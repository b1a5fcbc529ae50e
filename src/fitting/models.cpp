#include "fitting/models.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "fitting/bounded.h"
#include "fitting/mayaux2018.h"

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

std::vector<NamedFit> fit_jimenez_twice(const Curves& curves, Abscissa abscissa, Weights weights) {
  expect_bounces(curves, 2, "jimenez");
  const std::vector<double> albedos = fit_albedos();
  const int count = static_cast<int>(albedos.size());
  return {{"jimenez", fit_jimenez(visibility_points(curves, albedos, weights), count)},
          {"jimenez_ao", fit_jimenez(total_points(curves, albedos, abscissa, weights), count)}};
}

}  // namespace

const std::vector<FitModel>& fit_models() {
  static const std::vector<FitModel> models = {
      {"published", "F0 and F1 of the notes of 2018", fit_mayaux2018},
      {"bounded", "F0 and tau that stay within 0..1", fit_bounded},
      {"bounces", "each bounce on its own", fit_bounces},
      {"jimenez", "their cubic over the cosine-weighted and over the uniform visible fraction",
       fit_jimenez_twice},
  };
  return models;
}

std::vector<NamedFit> fit_model(const std::string& name, const Curves& curves, Abscissa abscissa,
                                Weights weights) {
  for (const FitModel& model : fit_models()) {
    if (name != model.name) continue;
    std::vector<NamedFit> fits = model.fit(curves, abscissa, weights);
    for (NamedFit& named : fits) {
      named.fit.abscissa = abscissa;
      named.fit.weights = weights;
    }
    return fits;
  }
  throw InputError(fmt::format("no model '{}', expected one of fit_models", name));
}

std::vector<std::string> fit_warnings(const std::vector<NamedFit>& fits) {
  std::vector<std::string> warnings;
  for (const auto& [name, fit] : fits) {
    for (const FitParameter& parameter : fit.parameters) {
      if (!parameter.standard_error) {
        warnings.push_back(fmt::format("{}: {} = {:.6g} is on its bound and has no standard error", name,
                                       parameter.name, parameter.value));
      } else if (*parameter.standard_error > std::abs(parameter.value)) {
        warnings.push_back(fmt::format("{}: {} = {:.6g} ± {:.2g} is not told from 0", name, parameter.name,
                                       parameter.value, *parameter.standard_error));
      }
    }
  }
  return warnings;
}

}  // namespace hemibake
