// Bytes compressed and written as text, to be embedded in a page.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace hemibake {

// Returns a zlib stream (RFC 1950) at the highest compression; browsers call it "deflate".
std::string deflate_bytes(std::span<const uint8_t> bytes);

// Returns base64 (RFC 4648) with its padding, on one line. At most 2³¹ bytes.
std::string base64(std::string_view bytes);

}  // namespace hemibake
