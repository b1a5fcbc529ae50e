// Checks a TGA with a palette without decoding it: OpenImageIO looks colours up wherever an index leads.
#pragma once

#include <filesystem>
#include <string>

namespace hemibake {

// Returns the fault of a TGA's palette and of the indices into it; empty where there is none or no palette.
// path: an image that TGA's header stands in. Throws InputError where it cannot be read.
std::string targa_error(const std::filesystem::path& path);

}  // namespace hemibake
