// Chunk layout: Portable Network Graphics (PNG) Specification, W3C 2003, §5.3.
#include "io/png_check.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string_view>
#include <vector>

#include "core/context.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

using std::string_view_literals::operator""sv;

constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n"sv;
constexpr size_t kBlockBytes = size_t{1} << 20;

bool read_exactly(std::ifstream& file, char* bytes, size_t count) {
  file.read(bytes, static_cast<std::streamsize>(count));
  return file.gcount() == static_cast<std::streamsize>(count);
}

uint32_t big_endian(const char* bytes) {
  uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value = value << 8 | static_cast<uint8_t>(bytes[i]);
  return value;
}

uint32_t add_to_crc(uint32_t crc, const char* bytes, size_t count) {
  return static_cast<uint32_t>(crc32(crc, reinterpret_cast<const Bytef*>(bytes), static_cast<uInt>(count)));
}

std::string complaint_about_header(const char* data) {
  const uint64_t width = big_endian(data), height = big_endian(data + 4);
  if (width * height <= kMaxTexels) return "";
  return fmt::format("claims {} x {} texels, expected at most {}", width, height, kMaxTexels);
}

}  // namespace

std::string png_error(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(kBlockBytes);
  if (!read_exactly(file, block.data(), kSignature.size()) ||
      std::string_view(block.data(), kSignature.size()) != kSignature)
    return "";
  for (;;) {
    char head[8];  // length, type
    if (!read_exactly(file, head, sizeof(head))) return "is cut short, expected a whole PNG";
    const std::string_view type(head + 4, 4);
    uint32_t crc = add_to_crc(0, head + 4, 4);
    for (size_t left = big_endian(head); left > 0;) {
      throw_if_cancelled();
      const size_t count = std::min(left, block.size());
      if (!read_exactly(file, block.data(), count)) return "is cut short, expected a whole PNG";
      crc = add_to_crc(crc, block.data(), count);
      left -= count;
    }
    char stored_crc[4];
    if (!read_exactly(file, stored_crc, sizeof(stored_crc))) return "is cut short, expected a whole PNG";
    if (big_endian(stored_crc) != crc) return "is damaged (a CRC does not fit), expected a whole PNG";
    if (type == "IHDR" && big_endian(head) == 13)
      if (std::string complaint = complaint_about_header(block.data()); !complaint.empty()) return complaint;
    if (type == "IEND") return "";
  }
}

}  // namespace hemibake
