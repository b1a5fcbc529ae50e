// Text of others made fit to be printed: names and values out of files may hold anything.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hemibake {

// Replaces every control character but line ends and tabs by U+FFFD, and every byte that is not UTF-8: no
// escape sequence reaches a terminal. Control are U+0000 to U+001F, U+007F to U+009F, and the marks that end
// lines or turn their direction (U+061C, U+200E, U+200F, U+2028 to U+202E, U+2066 to U+2069).
std::string printable_text(std::string_view text);

// As printable_text, and line ends and tabs become spaces: an error or a name stays one line.
std::string printable_line(std::string_view text);

// Returns printable_line of a text, cut to about `most` bytes and then ending in "…".
std::string excerpt(std::string_view text, size_t most = 60);

}  // namespace hemibake
