#include "cli/file_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "core/error.h"
#include "curves/check_curves.h"
#include "io/curves_file.h"
#include "io/fit_file.h"
#include "io/output_file.h"
#include "model/check_model.h"
#include "model/model.h"
#include "transport/energy.h"

namespace hemibake {
namespace {

constexpr double kDefaultTolerance = 2e-5;

template <class Value>
std::optional<Value> entry(const Provenance& provenance, const char* name) {
  if (!provenance.is_object() || !provenance.contains(name)) return std::nullopt;
  return provenance[name].get<Value>();
}

// α² ≤ E₀/π ≤ α(2−α) holds exactly for rays of equal solid angle, whose cosines are the midpoint rule; other ray sets
// know either fraction to N^-3/4 (FACTS.md §6).
double bounds_tolerance(const Provenance& provenance) {
  const bool exact = entry<std::string>(provenance, "tracer") == "embree" &&
                     entry<std::string>(provenance, "directions") == "uniform" &&
                     entry<double>(provenance, "cone_degrees").value_or(180) >= 180;
  return exact ? 1e-5 : 4 * std::pow(entry<double>(provenance, "rays").value_or(1), -0.75);
}

void check_numbers(const NamedFit& named, Checks& checks) {
  for (const FitParameter& parameter : named.fit.parameters) {
    // Any finite value passes: the distance of NaN and infinity to 0 is not below infinity.
    const bool finite = std::isfinite(parameter.value) && std::isfinite(parameter.standard_error.value_or(0));
    checks.push_back({fmt::format("{}: {} and its error are numbers", named.name, parameter.name), finite ? 1.0 : 0.0, 1, 0, ""});
  }
  checks.push_back({named.name + ": rms of the fit", named.fit.rms, 0, std::numeric_limits<double>::infinity(), ""});
}

Checks checks_of_fit(const FitFile& file, double tolerance) {
  Checks checks;
  std::map<std::string, double> published;
  for (const NamedFit& named : file.fits) {
    check_numbers(named, checks);
    if (named.name != "F0" && named.name != "F1") continue;
    for (const FitParameter& parameter : named.fit.parameters) published[parameter.name] = parameter.value;
  }
  if (published.contains("k") && published.contains("e") && published.contains("A") && published.contains("B")) {
    const PublishedModel model{published["k"], published["e"], published["A"], published["B"]};
    for (Check& check : check_model(model, tolerance)) checks.push_back(std::move(check));
  }
  return checks;
}

}  // namespace

Checks checks_of_bake(const BakeFile& file, std::optional<double> tolerance) {
  const Provenance& p = file.provenance;
  BakeCheckOptions options;
  options.energy_tolerance = tolerance;
  // A bake that was to converge is held to it; twice the tolerance for what comes above it.
  if (!tolerance && entry<double>(p, "converge")) options.energy_tolerance = 2 * *entry<double>(p, "converge");
  options.bounds_tolerance = bounds_tolerance(p);
  if (const auto row_sum_error = entry<double>(p, "row_sum_error"))
    options.link_energy = LinkEnergy{*row_sum_error, entry<double>(p, "light_over_opening"),
                                     entry<double>(p, "light_over_opening_stderr").value_or(0)};
  options.tiled_with_own_normals =
      entry<std::string>(p, "edge") == "wrap" && entry<std::string>(p, "normals").value_or("").starts_with("from ");
  return check_bake(file.bake, options);
}

Checks checks_of_file(const std::filesystem::path& path, std::optional<double> tolerance) {
  const std::string extension = lower_case_extension(path);
  if (extension == ".exr") return checks_of_bake(read_bake(path), tolerance);
  if (extension == ".csv")
    return check_curves(read_curves(path), tolerance.value_or(kDefaultTolerance), tolerance.has_value());
  if (extension == ".json") return checks_of_fit(read_fits(path), tolerance.value_or(kDefaultTolerance));
  throw InputError(path.string() + ": nothing to check by that name, expected a bake (.exr), curves (.csv) or fits (.json)");
}

}  // namespace hemibake
