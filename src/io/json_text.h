// The one way in for JSON: files, attributes of images, and what child processes say.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace hemibake {

constexpr size_t kMaxJsonBytes = size_t{64} << 20;
constexpr size_t kMaxJsonValues = 2000000;
constexpr int kMaxJsonDepth = 64;

// Parses a document, names in their order, in time and memory linear in its length. Throws InputError
// "PLACE: line 2, column 6: …" where it is no JSON or UTF-8, a number is too large for a double, an object
// has a name twice, it nests deeper than kMaxJsonDepth, or is longer than kMaxJsonBytes or kMaxJsonValues.
// place: where the text is from, in front of the error: "FILE" or "FILE: attribute NAME".
nlohmann::ordered_json parse_json(std::string_view text, const std::string& place);

}  // namespace hemibake
