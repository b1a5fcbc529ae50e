// Reads heights without a header: World Machine, Unity and Unreal write `.r16`, `.raw`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/height_file.h"

namespace hemibake {

// Reads a raw file, rows from the top. Throws InputError where its size is another, with the sizes that fit.
// layout: "WxH:TYPE" as HeightFileOptions::raw.
HeightFile read_raw_file(const std::filesystem::path& path, const std::string& layout,
                         std::optional<double> no_data);

// Returns whether the name says that a file has no header: .raw, .r16, …
bool is_raw_name(const std::filesystem::path& path);

// Returns "it has 524288 bytes, as --raw 512x512:u16le has": what its size and name suggest.
std::string raw_suggestion(const std::filesystem::path& path);

}  // namespace hemibake
