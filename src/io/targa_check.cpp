// The fields of the header as in "Truevision TGA File Format Specification", version 2.0, 1991.
#include "io/targa_check.h"

#include <fmt/format.h>

#include <string_view>

#include "io/byte_reader.h"
#include "io/input_file.h"

namespace hemibake {
namespace {

constexpr size_t kHeaderBytes = 18;
constexpr uint64_t kPalette = 1, kPaletteByRuns = 9;  // kinds of images
constexpr const char* kCutShort = "is cut short, expected a whole TGA";

struct TargaHeader {
  size_t first_color, colors, color_bytes, texels, index_bytes, begin;
  bool by_runs;
};

TargaHeader read_header(std::string_view bytes) {
  const auto byte = [&](size_t place) { return size_t{static_cast<unsigned char>(bytes[place])}; };
  const auto word = [&](size_t place) { return byte(place) | byte(place + 1) << 8; };
  TargaHeader header{word(3),
                     word(5),
                     (byte(7) + 7) / 8,
                     word(12) * word(14),
                     (byte(16) + 7) / 8,
                     0,
                     byte(2) == kPaletteByRuns};
  header.begin = kHeaderBytes + byte(0) + header.colors * header.color_bytes;
  return header;
}

// Walks the indices of the texels. Returns their fault.
std::string index_fault(std::string_view bytes, const TargaHeader& header) {
  size_t place = header.begin;
  for (size_t texel = 0; texel < header.texels;) {
    size_t count = header.texels, indices = header.texels;
    if (header.by_runs) {
      if (place >= bytes.size()) return kCutShort;
      const size_t packet = static_cast<unsigned char>(bytes[place++]);
      count = (packet & 0x7f) + 1;
      indices = (packet & 0x80) != 0 ? 1 : count;
    }
    if (place > bytes.size() || (bytes.size() - place) / header.index_bytes < indices) return kCutShort;
    for (size_t i = 0; i < indices; ++i, place += header.index_bytes) {
      size_t index = static_cast<unsigned char>(bytes[place]);
      if (header.index_bytes == 2) index |= size_t{static_cast<unsigned char>(bytes[place + 1])} << 8;
      if (index < header.first_color || index - header.first_color >= header.colors)
        return fmt::format("has a texel of colour {}, expected {} to {} as its palette has", index,
                           header.first_color, header.first_color + header.colors - 1);
    }
    texel += count;
  }
  return "";
}

}  // namespace

std::string targa_error(const std::filesystem::path& path) {
  std::error_code gone;
  if (const auto size = std::filesystem::file_size(path, gone); gone || size < kHeaderBytes) return kCutShort;
  const uint64_t kind = ByteReader(path).at(2, 1);
  if (kind != kPalette && kind != kPaletteByRuns) return "";
  const std::string bytes = read_whole_file(path);
  if (bytes.size() < kHeaderBytes) return kCutShort;
  const TargaHeader header = read_header(bytes);
  if (header.colors == 0 || header.index_bytes < 1 || header.index_bytes > 2)
    return "has a damaged palette, expected indices of 8 or 16 bits into colours";
  return index_fault(bytes, header);
}

}  // namespace hemibake
