// Whether a PNG is whole, found without decoding it: libpng takes a file cut short after its last texel for
// whole, and prints to standard error what it finds wrong.
#pragma once

#include <filesystem>
#include <string>

namespace hemibake {

// What is wrong with the chunks of a PNG: one cut short, one whose CRC-32 does not fit, no end chunk, or a
// header that claims more than kMaxTexels. Empty where nothing is, and for a file that is no PNG at all.
std::string png_error(const std::filesystem::path& path);

}  // namespace hemibake
