// Reads a height map saved by NumPy (`numpy.save`).
#pragma once

#include <filesystem>
#include <optional>

#include "io/height_file.h"

namespace hemibake {

// Returns whether a file starts as the format does.
bool is_npy_file(const std::filesystem::path& path);

// Reads an array of rows × columns, or rows × columns × 1. Throws InputError for another shape or type, and
// where the file is cut short.
HeightFile read_npy_file(const std::filesystem::path& path, std::optional<double> no_data);

}  // namespace hemibake
