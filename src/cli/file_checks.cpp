#include "cli/file_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bake/energy.h"
#include "core/error.h"
#include "curves/check_curves.h"
#include "io/curves_file.h"
#include "io/file_context.h"
#include "io/fit_file.h"
#include "io/json_reader.h"
#include "io/output_file.h"
#include "model/check_model.h"
#include "model/model.h"

namespace hemibake {
namespace {

constexpr double kDefaultTolerance = 2e-5;
constexpr double kMostRays = 1 << 20;
constexpr double kMostError = 1e30;  // of what a bake measured of itself

std::optional<JsonReader> entry(const Provenance& provenance, const char* name) {
  if (!provenance.is_object() || !provenance.contains(name)) return std::nullopt;
  return JsonReader(provenance[name], fmt::format("attribute hemibake:{}", name));
}

std::string text_entry(const Provenance& provenance, const char* name) {
  const auto found = entry(provenance, name);
  return found ? found->text() : "";
}

std::optional<double> number_entry(const Provenance& provenance, const char* name, double low, double high) {
  const auto found = entry(provenance, name);
  return found ? std::optional(found->number(low, high)) : std::nullopt;
}

// α² ≤ E₀/π ≤ α(2−α) holds exactly for rays of equal solid angle, whose cosines are the midpoint rule; other
// ray sets know either fraction to N^-3/4.
double bounds_tolerance(const Provenance& provenance) {
  const bool exact = text_entry(provenance, "tracer") == "embree" &&
                     text_entry(provenance, "directions") == "uniform" &&
                     number_entry(provenance, "cone_degrees", 0, 180).value_or(180) >= 180;
  return exact ? 1e-5 : 4 * std::pow(number_entry(provenance, "rays", 1, kMostRays).value_or(1), -0.75);
}

void check_numbers(const NamedFit& named, Checks& checks) {
  for (const FitParameter& parameter : named.fit.parameters) {
    // Any finite value passes: the distance of NaN and infinity to 0 is not below infinity.
    const bool finite = std::isfinite(parameter.value) && std::isfinite(parameter.standard_error.value_or(0));
    checks.push_back({fmt::format("{}: {} and its error are numbers", named.name, parameter.name),
                      finite ? 1.0 : 0.0, 1, 0, parameter.on_bound ? "on its bound" : ""});
  }
  checks.push_back(
      {named.name + ": rms of the fit", named.fit.rms, 0, std::numeric_limits<double>::infinity(), ""});
}

// Returns all parameters of the fits called `direct` and `bounces` by name; none unless both are there.
std::map<std::string, double> parameters_of(const FitFile& file, const char* direct, const char* bounces) {
  std::map<std::string, double> parameters;
  int found = 0;
  for (const NamedFit& named : file.fits) {
    if (named.name != direct && named.name != bounces) continue;
    ++found;
    for (const FitParameter& parameter : named.fit.parameters) parameters[parameter.name] = parameter.value;
  }
  if (found < 2) parameters.clear();
  return parameters;
}

void append_model_checks(const char* name, Checks model_checks, bool judged, Checks& checks) {
  for (Check& check : model_checks) {
    check.quantity = fmt::format("{}: {}", name, check.quantity);
    if (!judged) check.tolerance = std::numeric_limits<double>::infinity();
    checks.push_back(std::move(check));
  }
}

// Returns the models of the least and the largest m of the file's maps; those of all others lie in between.
std::vector<MeanEscapeModel> mean_escape_models(const FitFile& file) {
  std::vector<MeanEscapeModel> models;
  for (const MapEscape& map : file.escapes)
    if (map.mean_escape) models.push_back({*map.mean_escape});
  if (models.size() < 2) return models;
  const auto [least, largest] = std::ranges::minmax_element(models, {}, &MeanEscapeModel::mean_escape);
  return {*least, *largest};
}

// Checks the models of V and of V and α that `export` makes of the file. Throws InputError where a constant
// is outside its range.
void append_escape_checks(const FitFile& file, double tolerance, Checks& checks) {
  constexpr ModelKind kOfV = ModelKind::kVisibility, kOfBoth = ModelKind::kVisibilityAo;
  const auto append = [&](const std::string& name, const auto& model) {
    append_model_checks(name.c_str(), check_model(model, tolerance), true, checks);
  };
  if (has_model(file.fits, kOfV))
    append("visibility", std::get<VisibilityModel>(any_fitted_model(file.fits, kOfV)));
  if (has_model(file.fits, kOfBoth))
    append("visibility-ao", std::get<VisibilityAoModel>(any_fitted_model(file.fits, kOfBoth)));
  for (const MeanEscapeModel& model : mean_escape_models(file))
    append(fmt::format("visibility-ao-mean, m = {:.3g}", model.mean_escape), model);
}

// The bounded model is what export writes: where it is there, it is judged, and the published one, which is
// 0/0 at α = 1 and may have poles before, is shown.
Checks checks_of_fit(const FitFile& file, double tolerance) {
  Checks checks;
  for (const NamedFit& named : file.fits) check_numbers(named, checks);
  auto bounded = parameters_of(file, "bounded_F0", "bounded_tau");
  auto published = parameters_of(file, "F0", "F1");
  if (!bounded.empty())
    append_model_checks(
        "bounded",
        check_model(BoundedModel{bounded["k0"], bounded["k1"], bounded["q"], bounded["d"]}, tolerance), true,
        checks);
  if (!published.empty())
    append_model_checks(
        "published",
        check_model(Mayaux2018Model{published["k"], published["e"], published["A"], published["B"]},
                    tolerance),
        bounded.empty(), checks);
  append_escape_checks(file, tolerance, checks);
  return checks;
}

}  // namespace

Checks checks_of_bake(const BakeFile& file, std::optional<double> tolerance) {
  const Provenance& p = file.provenance;
  BakeCheckOptions options;
  options.energy_tolerance = tolerance;
  // A bake that was to converge is held to it; twice the tolerance for what comes above it.
  if (const auto converge = number_entry(p, "converge", 0, 1); converge && !tolerance)
    options.energy_tolerance = 2 * *converge;
  options.bounds_tolerance = bounds_tolerance(p);
  if (const auto row_sum_error = number_entry(p, "row_sum_error", 0, kMostError))
    options.link_energy = LinkEnergy{*row_sum_error, number_entry(p, "light_over_opening", 0, kMostError),
                                     number_entry(p, "light_over_opening_stderr", 0, kMostError).value_or(0)};
  options.tiled_with_own_normals =
      text_entry(p, "edge") == "wrap" && text_entry(p, "normals").starts_with("from ");
  return check_bake(file.bake, options);
}

Checks checks_of_file(const std::filesystem::path& path, std::optional<double> tolerance) {
  const std::string extension = lower_case_extension(path);
  if (extension == ".exr") {
    const BakeFile file = read_bake(path);
    const Checks checks = with_file_context(path, [&] { return checks_of_bake(file, tolerance); });
    if (checks.empty())
      throw InputError(path.string() + ": holds no irradiance, expected some: nothing else is checked");
    return checks;
  }
  if (extension == ".csv")
    return check_curves(read_curves(path), tolerance.value_or(kDefaultTolerance), tolerance.has_value());
  if (extension == ".json") {
    const FitFile file = read_fits(path);
    if (file.fits.empty() && file.escapes.empty())
      throw InputError(path.string() + ": holds no fits, expected some: nothing is checked");
    return with_file_context(path,
                             [&] { return checks_of_fit(file, tolerance.value_or(kDefaultTolerance)); });
  }
  throw InputError(path.string() +
                   ": nothing to check by that name, expected a bake (.exr), curves (.csv) or fits (.json)");
}

}  // namespace hemibake
