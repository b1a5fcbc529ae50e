// Breaks text into lines of a terminal.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

namespace hemibake {

// Returns the columns of UTF-8 text without combining characters.
inline size_t columns_of(const std::string& text) {
  return static_cast<size_t>(
      std::ranges::count_if(text, [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

// Joins `pieces` with ", " into lines of at most `width` columns, each after `indent` spaces.
inline std::string wrap_list(const std::vector<std::string>& pieces, size_t indent, size_t width) {
  std::string text, line;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const std::string piece = pieces[i] + (i + 1 < pieces.size() ? "," : "");
    if (!line.empty() && indent + columns_of(line) + 1 + columns_of(piece) > width) {
      text += fmt::format("{:{}}{}\n", "", indent, line);
      line.clear();
    }
    line += (line.empty() ? "" : " ") + piece;
  }
  return text + fmt::format("{:{}}{}\n", "", indent, line);
}

// Returns a name in exactly `width` columns at the left: what is longer loses its middle.
inline std::string fit_name(const std::string& name, size_t width) {
  const size_t size = columns_of(name);
  if (size <= width) return name + std::string(width - size, ' ');
  if (size != name.size()) return fit_name("map of a long name", width);  // UTF-8 is not cut within a letter
  const size_t end = (width - 2) / 2, begin = width - 2 - end;
  return name.substr(0, begin) + ".." + name.substr(name.size() - end);
}

}  // namespace hemibake
