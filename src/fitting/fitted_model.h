// Makes models of the constants that fits hold.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fitting/fit.h"
#include "model/model.h"

namespace hemibake {

// Names a model that fits can hold, by the fits that it takes.
enum class ModelKind {
  kBounded,     // bounded_F0 and bounded_tau
  kMayaux2018,  // F0 and F1; guarded
};

// Parses `bounded` or `published`. Throws InputError for any other text.
ModelKind model_kind_from_string(std::string_view text);

// Returns whether `fits` hold every fit of the model.
bool has_model(std::span<const NamedFit> fits, ModelKind kind);

// Returns the model with the constants of `fits`. Throws InputError where a fit or a parameter is missing, or
// a value is outside the range in which every step of the formulas is finite in float.
ShaderModel fitted_model(std::span<const NamedFit> fits, ModelKind kind);

// Returns a line for each fit of the model: formula, constants with their errors, residuals. Throws
// InputError where a fit is missing.
std::vector<std::string> describe_fits(std::span<const NamedFit> fits, ModelKind kind);

}  // namespace hemibake
