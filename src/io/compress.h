// Bytes made small and made text, for what is embedded in a page.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace hemibake {

// A zlib stream (RFC 1950) at the highest compression; what browsers call "deflate".
std::string deflate_bytes(std::span<const uint8_t> bytes);

// RFC 4648, with its padding, on one line.
std::string base64(std::string_view bytes);

}  // namespace hemibake
