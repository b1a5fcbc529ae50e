#include "fitting/fitted_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/error.h"

namespace hemibake {
namespace {

struct FittedKind {
  const char* name;  // of the option --model
  std::vector<const char*> fits;
};

const std::vector<FittedKind>& fitted_kinds() {  // in the order of ModelKind
  static const std::vector<FittedKind> kinds = {
      {"visibility", {"visibility"}}, {"visibility-normal", {}}, {"visibility-ao", {"visibility_ao"}},
      {"visibility-ao-mean", {}},     {"bounce-map", {}},        {"bounded", {"bounded_F0", "bounded_tau"}},
      {"published", {"F0", "F1"}},    {"jimenez", {"jimenez"}},
  };
  return kinds;
}

const FittedKind& fits_of(ModelKind kind) { return fitted_kinds()[static_cast<size_t>(kind)]; }

const Fit* find_fit(std::span<const NamedFit> fits, std::string_view name) {
  const auto found = std::ranges::find(fits, name, &NamedFit::name);
  return found == fits.end() ? nullptr : &found->fit;
}

// Returns the fits of a model.
std::vector<const Fit*> expect_fits(std::span<const NamedFit> fits, ModelKind kind) {
  std::vector<const Fit*> found;
  const FittedKind& wanted = fits_of(kind);
  for (const char* name : wanted.fits) {
    found.push_back(find_fit(fits, name));
    if (!found.back())
      throw InputError(fmt::format("no fit {}, expected the fits of model '{}'", name, wanted.name));
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

const std::vector<std::string>& model_kind_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const FittedKind& kind : fitted_kinds()) list.emplace_back(kind.name);
    return list;
  }();
  return names;
}

ModelKind model_kind_from_string(std::string_view text) {
  const auto& names = model_kind_names();
  const auto found = std::ranges::find(names, text);
  if (found != names.end()) return static_cast<ModelKind>(found - names.begin());
  throw InputError(fmt::format("no model '{}', expected one of {}", text, fmt::join(names, ", ")));
}

bool has_model(std::span<const NamedFit> fits, ModelKind kind) {
  return std::ranges::all_of(fits_of(kind).fits, [&](const char* name) { return find_fit(fits, name); });
}

AnyModel any_fitted_model(std::span<const NamedFit> fits, ModelKind kind) {
  const std::vector<const Fit*> found = expect_fits(fits, kind);
  switch (kind) {
    case ModelKind::kVisibility:
      return VisibilityModel{constant(*found[0], "dark", 0, 1), constant(*found[0], "open", 0, 1)};
    case ModelKind::kVisibilityAo:
      return VisibilityAoModel{constant(*found[0], "dark", 0, 1), constant(*found[0], "open", 0, 1)};
    case ModelKind::kVisibilityNormal:
      return VisibilityNormalModel{};
    case ModelKind::kMeanEscape:
      return MeanEscapeModel{};
    case ModelKind::kBounceMap:
      return BounceMapModel{};
    case ModelKind::kBounded:
      return BoundedModel{constant(*found[0], "k0", -1, 1), constant(*found[0], "k1", -1, 1),
                          constant(*found[1], "q", 1e-6, 1), constant(*found[1], "d", 0, 0.999999)};
    case ModelKind::kMayaux2018:
      return GuardedModel{{constant(*found[0], "k", -100, 100), constant(*found[0], "e", 0, 100),
                           constant(*found[1], "A", 0, 1e9), constant(*found[1], "B", -60, 60)}};
    case ModelKind::kJimenez: {
      JimenezModel model;
      size_t i = 0;
      for (const char* name : {"a1", "a0", "b1", "b0", "c1", "c0"})
        model.parameters[i++] = constant(*found[0], name, -1e3, 1e3);
      return model;
    }
  }
  throw std::logic_error("an unknown kind of model");
}

ShaderModel fitted_model(std::span<const NamedFit> fits, ModelKind kind) {
  const AnyModel model = any_fitted_model(fits, kind);
  if (const auto* bounded = std::get_if<BoundedModel>(&model)) return *bounded;
  if (const auto* guarded = std::get_if<GuardedModel>(&model)) return *guarded;
  throw std::logic_error("no model of AO: " + model_kind_names()[static_cast<size_t>(kind)]);
}

std::optional<AnyModel> model_without_fits(ModelKind kind) {
  switch (kind) {
    case ModelKind::kVisibility:
      return VisibilityModel{0, 1};
    case ModelKind::kVisibilityAo:
      return VisibilityAoModel{0, 1};
    case ModelKind::kVisibilityNormal:
      return VisibilityNormalModel{};
    case ModelKind::kMeanEscape:
      return MeanEscapeModel{};
    case ModelKind::kBounceMap:
      return BounceMapModel{};
    case ModelKind::kBounded:
      return std::nullopt;
    case ModelKind::kMayaux2018:
      return GuardedModel{};
    case ModelKind::kJimenez:
      return JimenezModel{};
  }
  throw std::logic_error("an unknown kind of model");
}

std::vector<std::string> describe_fits(std::span<const NamedFit> fits, ModelKind kind) {
  std::vector<std::string> lines;
  for (const Fit* fit : expect_fits(fits, kind)) {
    std::string line = fmt::format("{} = {} with", fit->model, fit->formula);
    for (const FitParameter& parameter : fit->parameters) {
      line += fmt::format(" {} = {:.6g}", parameter.name, parameter.value);
      if (parameter.standard_error) line += fmt::format(" +- {:.2g}", *parameter.standard_error);
    }
    const bool of_ao = kind == ModelKind::kBounded || kind == ModelKind::kMayaux2018;
    lines.push_back(
        line + fmt::format(" ({}rms {:.2g}, max {:.2g})", of_ao ? "a = ao; " : "", fit->rms, fit->max_error));
  }
  return lines;
}

}  // namespace hemibake
