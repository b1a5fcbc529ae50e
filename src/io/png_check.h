// Checks a PNG without decoding it: libpng accepts a file cut short after its last texel, and prints its
// errors to standard error.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace hemibake {

struct PngHeader {
  uint32_t width = 0, height = 0;
  int bits = 0, channels = 0;  // as stored; a palette has one
  bool is_interlaced = false, has_palette = false;
};

// Reads the header into `header`. Returns its fault; empty where there is none.
// path: starts as a PNG does.
std::string png_header_error(const std::filesystem::path& path, PngHeader& header);

// Returns the fault of a PNG's chunks; empty where there is none. Faults: a chunk cut short, a wrong CRC-32,
// no end chunk, chunks that libpng refuses, texels that are damaged or not all there.
std::string png_error(const std::filesystem::path& path, const PngHeader& header);

}  // namespace hemibake
