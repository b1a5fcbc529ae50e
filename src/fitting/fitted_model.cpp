#include "fitting/fitted_model.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

const Fit& find_fit(const FitFile& file, const fs::path& path, std::string_view name,
                    std::string_view model) {
  for (const NamedFit& named : file.fits) {
    if (named.name == name) return named.fit;
  }
  throw InputError(
      fmt::format("{}: no fit {}, expected one from 'hemibake fit --model {}'", path.string(), name, model));
}

struct ConstantRange {
  const char* name;
  double lowest, highest;
};

double constant(const Fit& fit, const fs::path& path, const ConstantRange& range) {
  for (const FitParameter& parameter : fit.parameters) {
    if (parameter.name != range.name) continue;
    if (parameter.value >= range.lowest && parameter.value <= range.highest) return parameter.value;
    throw InputError(fmt::format("{}: {} of {} is {}, expected {} to {}", path.string(), range.name,
                                 fit.model, parameter.value, range.lowest, range.highest));
  }
  throw InputError(
      fmt::format("{}: {} has no parameter {}, expected one", path.string(), fit.model, range.name));
}

std::vector<std::string> origin_lines(const FitFile& file, std::initializer_list<const Fit*> fits) {
  std::vector<std::string> lines = {
      "Ambient occlusion with all bounces of light, by hemibake " HEMIBAKE_VERSION "."};
  for (const Fit* fit : fits) {
    std::string line = fmt::format("{} = {} with", fit->model, fit->formula);
    for (const FitParameter& parameter : fit->parameters) {
      line += fmt::format(" {} = {:.6g}", parameter.name, parameter.value);
      if (parameter.standard_error) line += fmt::format(" +- {:.2g}", *parameter.standard_error);
    }
    lines.push_back(line + fmt::format(" (a = ao; rms {:.2g}, max {:.2g})", fit->rms, fit->max_error));
  }
  for (const char* name : {"input", "input_sha256", "command"}) {
    if (file.provenance.contains(name) && file.provenance[name].is_string()) {
      lines.push_back(fmt::format("{}: {}", name, file.provenance[name].get<std::string>()));
    }
  }
  return lines;
}

}  // namespace

bool has_fit(const FitFile& file, std::string_view name) {
  return std::any_of(file.fits.begin(), file.fits.end(),
                     [&](const NamedFit& named) { return named.name == name; });
}

BoundedModel bounded_model(const FitFile& file, const fs::path& path) {
  const Fit& direct = find_fit(file, path, "bounded_F0", "bounded");
  const Fit& tau = find_fit(file, path, "bounded_tau", "bounded");
  return {constant(direct, path, {"k0", -1, 1}), constant(direct, path, {"k1", -1, 1}),
          constant(tau, path, {"q", 1e-6, 1}), constant(tau, path, {"d", 0, 0.999999})};
}

GuardedModel guarded_model(const FitFile& file, const fs::path& path) {
  const Fit& direct = find_fit(file, path, "F0", "published");
  const Fit& first = find_fit(file, path, "F1", "published");
  return {{constant(direct, path, {"k", -100, 100}), constant(direct, path, {"e", 0, 100}),
           constant(first, path, {"A", 0, 1e9}), constant(first, path, {"B", -60, 60})}};
}

std::vector<std::string> bounded_model_origin(const FitFile& file, const fs::path& path) {
  return origin_lines(file, {&find_fit(file, path, "bounded_F0", "bounded"),
                             &find_fit(file, path, "bounded_tau", "bounded")});
}

std::vector<std::string> guarded_model_origin(const FitFile& file, const fs::path& path) {
  return origin_lines(file,
                      {&find_fit(file, path, "F0", "published"), &find_fit(file, path, "F1", "published")});
}

}  // namespace hemibake
