// The models that a FIT.json holds the constants of.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/fit_file.h"
#include "model/model.h"

namespace hemibake {

// True where `file` has a fit called `name`.
bool has_fit(const FitFile& file, std::string_view name);

// From bounded_F0 and bounded_tau, as `hemibake fit --model bounded` writes them; from F0 and F1 of `--model
// published`. Throws InputError naming `path` where a fit or a parameter is missing, or a value is outside
// the range in which every step of the formulas is finite in float.
BoundedModel bounded_model(const FitFile& file, const std::filesystem::path& path);
GuardedModel guarded_model(const FitFile& file, const std::filesystem::path& path);

// Where the constants come from, for the head of a shader text: formula and parameters with their errors,
// input and command.
std::vector<std::string> bounded_model_origin(const FitFile& file, const std::filesystem::path& path);
std::vector<std::string> guarded_model_origin(const FitFile& file, const std::filesystem::path& path);

}  // namespace hemibake
