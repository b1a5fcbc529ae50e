// Checks a PNG without decoding it: libpng accepts a file cut short after its last texel, and prints its
// errors to standard error.
#pragma once

#include <filesystem>
#include <string>

namespace hemibake {

// Returns the fault of a PNG's chunks; empty where there is none, and for a file that is no PNG at all.
// Faults: a chunk cut short, a wrong CRC-32, no end chunk, a header that claims more than kMaxTexels.
std::string png_error(const std::filesystem::path& path);

}  // namespace hemibake
