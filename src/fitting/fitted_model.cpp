#include "fitting/fitted_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/error.h"

namespace hemibake {
namespace {

struct FittedKind {
  const char* name;  // of the option --model of `hemibake fit`
  std::array<const char*, 2> fits;
};

constexpr FittedKind kBoundedFits{"bounded", {"bounded_F0", "bounded_tau"}};
constexpr FittedKind kMayaux2018Fits{"published", {"F0", "F1"}};

const FittedKind& fits_of(ModelKind kind) {
  return kind == ModelKind::kBounded ? kBoundedFits : kMayaux2018Fits;
}

const Fit* find_fit(std::span<const NamedFit> fits, std::string_view name) {
  const auto found = std::ranges::find(fits, name, &NamedFit::name);
  return found == fits.end() ? nullptr : &found->fit;
}

// Returns the two fits of a model.
std::array<const Fit*, 2> expect_fits(std::span<const NamedFit> fits, ModelKind kind) {
  std::array<const Fit*, 2> found{};
  for (size_t i = 0; i < found.size(); ++i) {
    const FittedKind& wanted = fits_of(kind);
    found[i] = find_fit(fits, wanted.fits[i]);
    if (!found[i])
      throw InputError(
          fmt::format("no fit {}, expected the fits of model '{}'", wanted.fits[i], wanted.name));
  }
  return found;
}

double constant(const Fit& fit, const char* name, double lowest, double highest) {
  const auto found = std::ranges::find(fit.parameters, name, &FitParameter::name);
  if (found == fit.parameters.end())
    throw InputError(fmt::format("{} has no parameter {}, expected one", fit.model, name));
  if (found->value >= lowest && found->value <= highest) return found->value;
  throw InputError(
      fmt::format("{} of {} is {}, expected {} to {}", name, fit.model, found->value, lowest, highest));
}

}  // namespace

ModelKind model_kind_from_string(std::string_view text) {
  for (const ModelKind kind : {ModelKind::kBounded, ModelKind::kMayaux2018})
    if (text == fits_of(kind).name) return kind;
  throw InputError(fmt::format("no model '{}', expected bounded or published", text));
}

bool has_model(std::span<const NamedFit> fits, ModelKind kind) {
  return std::ranges::all_of(fits_of(kind).fits, [&](const char* name) { return find_fit(fits, name); });
}

ShaderModel fitted_model(std::span<const NamedFit> fits, ModelKind kind) {
  const auto [direct, second] = expect_fits(fits, kind);
  if (kind == ModelKind::kBounded)
    return BoundedModel{constant(*direct, "k0", -1, 1), constant(*direct, "k1", -1, 1),
                        constant(*second, "q", 1e-6, 1), constant(*second, "d", 0, 0.999999)};
  return GuardedModel{{constant(*direct, "k", -100, 100), constant(*direct, "e", 0, 100),
                       constant(*second, "A", 0, 1e9), constant(*second, "B", -60, 60)}};
}

std::vector<std::string> describe_fits(std::span<const NamedFit> fits, ModelKind kind) {
  std::vector<std::string> lines;
  for (const Fit* fit : expect_fits(fits, kind)) {
    std::string line = fmt::format("{} = {} with", fit->model, fit->formula);
    for (const FitParameter& parameter : fit->parameters) {
      line += fmt::format(" {} = {:.6g}", parameter.name, parameter.value);
      if (parameter.standard_error) line += fmt::format(" +- {:.2g}", *parameter.standard_error);
    }
    lines.push_back(line + fmt::format(" (a = ao; rms {:.2g}, max {:.2g})", fit->rms, fit->max_error));
  }
  return lines;
}

}  // namespace hemibake
