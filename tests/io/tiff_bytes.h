// Builds TIFFs of 8-bit grey, with what OpenImageIO does not write: kinds of subfiles and GDAL's tag.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hemibake {

struct TiffPageBytes {
  uint32_t width, height, subfile_type;
  std::string values;   // width × height bytes
  std::string no_data;  // text of tag 42113; empty: none
};

inline std::string tiff_bytes(const std::vector<TiffPageBytes>& pages, bool is_big_endian) {
  std::string bytes = is_big_endian ? "MM" : "II";
  const auto number = [&](uint32_t value, int count) {
    std::string text;
    for (int i = 0; i < count; ++i)
      text += static_cast<char>(value >> 8 * (is_big_endian ? count - 1 - i : i));
    return text;
  };
  bytes += number(42, 2) + number(8, 4);
  for (size_t i = 0; i < pages.size(); ++i) {
    const TiffPageBytes& page = pages[i];
    const bool has_no_data = !page.no_data.empty();
    const uint32_t entries = has_no_data ? 11 : 10;
    const auto values_at = static_cast<uint32_t>(bytes.size()) + 2 + 12 * entries + 4;
    const auto text_at = values_at + static_cast<uint32_t>(page.values.size());
    std::string text = page.no_data + '\0';
    bytes += number(entries, 2);
    const auto long_entry = [&](uint32_t tag, uint32_t value) {
      bytes += number(tag, 2) + number(4, 2) + number(1, 4) + number(value, 4);
    };
    const auto short_entry = [&](uint32_t tag, uint32_t value) {
      bytes += number(tag, 2) + number(3, 2) + number(1, 4) + number(value, 2) + number(0, 2);
    };
    long_entry(254, page.subfile_type);
    long_entry(256, page.width);
    long_entry(257, page.height);
    short_entry(258, 8);
    short_entry(259, 1);
    short_entry(262, page.subfile_type & 4 ? 4 : 1);
    long_entry(273, values_at);
    short_entry(277, 1);
    long_entry(278, page.height);
    long_entry(279, static_cast<uint32_t>(page.values.size()));
    if (has_no_data) {
      bytes += number(42113, 2) + number(2, 2) + number(static_cast<uint32_t>(text.size()), 4);
      bytes += text.size() <= 4 ? text + std::string(4 - text.size(), '\0') : number(text_at, 4);
    }
    const auto end = text_at + (has_no_data ? static_cast<uint32_t>(text.size()) : 0);
    bytes += number(i + 1 < pages.size() ? end : 0, 4) + page.values;
    if (has_no_data) bytes += text;
  }
  return bytes;
}

}  // namespace hemibake
