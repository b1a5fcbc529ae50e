// The checks of a file as read back: what it says of itself decides what can be asked of it.
#pragma once

#include <filesystem>
#include <optional>

#include "core/check.h"
#include "io/bake_file.h"

namespace hemibake {

// tolerance: of the energy sum; absent: light the bake says is still under way may be missing.
Checks checks_of_bake(const BakeFile& file, std::optional<double> tolerance);

// By extension: .exr a bake, .csv curves, .json fits. Throws InputError for any other, or what does not read.
Checks checks_of_file(const std::filesystem::path& path, std::optional<double> tolerance);

}  // namespace hemibake
