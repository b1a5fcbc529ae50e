#include "core/printable.h"

#include <algorithm>

namespace hemibake {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

struct Character {
  char32_t code = 0;
  size_t bytes = 0;  // 0: is no UTF-8
};

// Reads the character that `text`, which is not empty, begins with.
Character first_character(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const size_t bytes = byte(0) < 0x80 ? 1 : byte(0) < 0xC2 ? 0 : byte(0) < 0xE0 ? 2 : byte(0) < 0xF0 ? 3 : 4;
  if (bytes == 0 || bytes > text.size() || byte(0) > 0xF4) return {};
  char32_t code = bytes == 1 ? byte(0) : byte(0) & (0x7Fu >> bytes);
  for (size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return {};
    code = code << 6 | (byte(i) & 0x3F);
  }
  // Longer than needed, half of a pair, or beyond the last.
  constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  if (code < kLeast[bytes] || (code >= 0xD800 && code <= 0xDFFF) || code > 0x10FFFF) return {};
  return {code, bytes};
}

bool is_control(char32_t code) {
  return code < 0x20 || (code >= 0x7F && code <= 0x9F) || code == 0x061C || code == 0x200E ||
         code == 0x200F || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
}

// kept: control characters that stay. spaced: those that become spaces.
std::string replace_controls(std::string_view text, std::string_view kept, std::string_view spaced) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_character(text);
    const std::string_view piece = text.substr(0, std::max<size_t>(1, character.bytes));
    if (character.bytes == 1 && spaced.find(piece[0]) != std::string_view::npos)
      result += ' ';
    else if (character.bytes == 1 && kept.find(piece[0]) != std::string_view::npos)
      result += piece;
    else
      result += character.bytes == 0 || is_control(character.code) ? kReplacement : piece;
    text.remove_prefix(piece.size());
  }
  return result;
}

}  // namespace

std::string printable_text(std::string_view text) { return replace_controls(text, "\n\t", ""); }

std::string printable_line(std::string_view text) { return replace_controls(text, "", "\n\r\t"); }

std::string excerpt(std::string_view text, size_t most) {
  if (text.size() <= most) return printable_line(text);
  // Not within a character.
  while (most > 0 && (static_cast<unsigned char>(text[most]) & 0xC0) == 0x80) --most;
  return printable_line(text.substr(0, most)) + "…";
}

}  // namespace hemibake
