// Makes models of the constants that fits hold.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/fit.h"
#include "model/model.h"

namespace hemibake {

// Names a model by the fits that it takes.
enum class ModelKind {
  kVisibility,        // visibility
  kVisibilityNormal,  // none: it has no constants
  kVisibilityAo,      // visibility_ao
  kMeanEscape,        // none: its constant is the mean escape share of a map
  kBounceMap,         // none: its constant is the albedo of the bounce map
  kBounded,           // bounded_F0 and bounded_tau
  kMayaux2018,        // F0 and F1; guarded
  kJimenez,           // jimenez
};

// Returns the names of all kinds, in the order of the enumerators.
const std::vector<std::string>& model_kind_names();

// Parses a name of model_kind_names. Throws InputError for any other text.
ModelKind model_kind_from_string(std::string_view text);

// Returns whether `fits` hold every fit of the model.
bool has_model(std::span<const NamedFit> fits, ModelKind kind);

// Returns the model with the constants of `fits`. Throws InputError where a fit or a parameter is missing, or
// a value is outside the range in which every step of the formulas is finite in float.
AnyModel any_fitted_model(std::span<const NamedFit> fits, ModelKind kind);

// Returns a model of α, as any_fitted_model does. kind: kBounded or kMayaux2018.
ShaderModel fitted_model(std::span<const NamedFit> fits, ModelKind kind);

// Returns the model with the constants that it has without fits: g = V, g = α, those of 2018 and 2016. None
// for kBounded.
std::optional<AnyModel> model_without_fits(ModelKind kind);

// Returns a line for each fit of the model: formula, constants with their errors, residuals. Throws
// InputError where a fit is missing.
std::vector<std::string> describe_fits(std::span<const NamedFit> fits, ModelKind kind);

}  // namespace hemibake
