// Layout: Portable Network Graphics (PNG) Specification, W3C 2003, §5.3, §8.2, §11.2.
#include "io/png_check.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <vector>

#include "core/context.h"

namespace hemibake {
namespace {

constexpr size_t kSignatureBytes = 8, kHeaderBytes = 13;
constexpr size_t kBlockBytes = size_t{1} << 20;
constexpr const char* kCutShort = "is cut short, expected a whole PNG";

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

// Rows of one pass of the texels, each after a byte that names its filter.
struct Pass {
  uint64_t row_bytes, rows;
};

std::vector<Pass> passes_of(const PngHeader& header) {
  constexpr std::array<std::array<uint32_t, 4>, 7> kAdam7{{{0, 0, 8, 8},
                                                           {4, 0, 8, 8},
                                                           {0, 4, 4, 8},
                                                           {2, 0, 4, 4},
                                                           {0, 2, 2, 4},
                                                           {1, 0, 2, 2},
                                                           {0, 1, 1, 2}}};  // x, y, steps
  const auto texel_bits = static_cast<uint64_t>(header.bits) * static_cast<uint64_t>(header.channels);
  const auto row_bytes = [&](uint64_t width) { return 1 + (width * texel_bits + 7) / 8; };
  if (!header.is_interlaced) return {{row_bytes(header.width), header.height}};
  std::vector<Pass> passes;
  for (const auto& [x, y, step_x, step_y] : kAdam7)
    if (header.width > x && header.height > y)
      passes.push_back({row_bytes((uint64_t{header.width} - x + step_x - 1) / step_x),
                        (uint64_t{header.height} - y + step_y - 1) / step_y});
  return passes;
}

// Inflates the texels piece by piece and looks only at the filters of the rows.
class TexelCheck {
 public:
  explicit TexelCheck(const PngHeader& header) : passes_(passes_of(header)), out_(kBlockBytes) {
    is_broken_ = inflateInit(&stream_) != Z_OK;
  }
  ~TexelCheck() { inflateEnd(&stream_); }
  TexelCheck(const TexelCheck&) = delete;
  TexelCheck& operator=(const TexelCheck&) = delete;

  void add(const char* bytes, size_t count) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes));
    stream_.avail_in = static_cast<uInt>(count);
    while (!is_broken_ && !is_ended_ && pass_ < passes_.size()) {
      throw_if_cancelled();
      stream_.next_out = out_.data();
      stream_.avail_out = static_cast<uInt>(out_.size());
      const int result = inflate(&stream_, Z_NO_FLUSH);
      is_ended_ = result == Z_STREAM_END;
      is_broken_ = result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR;
      take(out_.size() - stream_.avail_out);
      if (stream_.avail_out > 0) break;
    }
  }

  // Returns what is wrong with the texels; empty: nothing.
  std::string fault() const {
    if (!is_broken_ && pass_ == passes_.size()) return "";
    return fmt::format("is damaged or cut short near row {}, expected a whole PNG", rows_done_);
  }

 private:
  void take(size_t count) {
    for (size_t at = 0; at < count && !is_broken_ && pass_ < passes_.size();) {
      constexpr int kFilters = 5;
      if (in_row_ == 0 && out_[at] >= kFilters) is_broken_ = true;
      const auto step =
          static_cast<size_t>(std::min<uint64_t>(count - at, passes_[pass_].row_bytes - in_row_));
      at += step;
      in_row_ += step;
      if (in_row_ < passes_[pass_].row_bytes) break;
      in_row_ = 0;
      if (++rows_done_ < passes_[pass_].rows) continue;
      rows_done_ = 0;
      ++pass_;
    }
  }

  std::vector<Pass> passes_;
  std::vector<Bytef> out_;
  z_stream stream_{};
  size_t pass_ = 0;
  uint64_t rows_done_ = 0, in_row_ = 0;  // in_row_: bytes
  bool is_broken_ = false, is_ended_ = false;
};

// Finds chunks that libpng refuses: those it must know but does not, and those out of their order.
class ChunkOrder {
 public:
  explicit ChunkOrder(const PngHeader& header) : header_(header) {}

  bool allows(std::string_view type, uint32_t size) {
    constexpr uint32_t kMostPalette = 3 * 256;
    const bool is_letters =
        std::ranges::all_of(type, [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); });
    const bool is_first = count_++ == 0;
    if (!is_letters || is_first != (type == "IHDR") || size > INT32_MAX) return false;
    if (type == "PLTE") {
      const bool is_fit = !has_palette_ && !has_texels_ && size % 3 == 0 && size > 0 && size <= kMostPalette;
      has_palette_ = true;
      return is_fit;
    }
    if (type == "IDAT") {
      const bool is_fit = (!header_.has_palette || has_palette_) && (!has_texels_ || last_was_texels_);
      has_texels_ = last_was_texels_ = true;
      return is_fit;
    }
    last_was_texels_ = false;
    const bool is_needed = type[0] >= 'A' && type[0] <= 'Z';
    return !is_needed || type == "IHDR" || type == "IEND";
  }

 private:
  const PngHeader& header_;
  int count_ = 0;
  bool has_palette_ = false, has_texels_ = false, last_was_texels_ = false;
};

// Passes the bytes of a chunk on. Returns its fault.
template <class Visit>
std::string read_chunk(std::ifstream& file, const char* head, std::vector<char>& block, const Visit& visit) {
  uint32_t crc = add_to_crc(0, head + 4, 4);
  for (size_t left = big_endian(head); left > 0;) {
    throw_if_cancelled();
    const size_t count = std::min(left, block.size());
    if (!read_exactly(file, block.data(), count)) return kCutShort;
    crc = add_to_crc(crc, block.data(), count);
    visit(block.data(), count);
    left -= count;
  }
  char stored_crc[4];
  if (!read_exactly(file, stored_crc, sizeof(stored_crc))) return kCutShort;
  return big_endian(stored_crc) == crc ? "" : "is damaged (a CRC does not fit), expected a whole PNG";
}

}  // namespace

std::string png_header_error(const std::filesystem::path& path, PngHeader& header) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, kSignatureBytes + 8 + kHeaderBytes> bytes{};
  if (!read_exactly(file, bytes.data(), bytes.size())) return kCutShort;
  const char* const data = &bytes[kSignatureBytes + 8];
  const bool is_header = std::string_view(&bytes[kSignatureBytes + 4], 4) == "IHDR" &&
                         big_endian(&bytes[kSignatureBytes]) == kHeaderBytes;
  constexpr std::array<int, 7> kChannels{1, 0, 3, 1, 2, 0, 4};  // of the colour types
  const auto kind = static_cast<uint8_t>(data[9]);
  header = {big_endian(data), big_endian(data + 4), data[8], kind < 7 ? kChannels[kind] : 0, data[12] == 1,
            kind == 3};
  const int bits = header.bits;
  const bool is_small = bits == 1 || bits == 2 || bits == 4;
  const bool is_depth = bits == 8 || (bits == 16 && kind != 3) || (is_small && (kind == 0 || kind == 3));
  const bool is_size =
      header.width > 0 && header.height > 0 && header.width <= INT32_MAX && header.height <= INT32_MAX;
  if (!is_header || !is_size || !is_depth || header.channels == 0 || data[10] != 0 || data[11] != 0 ||
      data[12] < 0 || data[12] > 1)
    return "has a damaged header, expected a whole PNG";
  return "";
}

std::string png_error(const std::filesystem::path& path, const PngHeader& header) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> block(kBlockBytes);
  if (!read_exactly(file, block.data(), kSignatureBytes)) return kCutShort;
  ChunkOrder order(header);
  TexelCheck texels(header);
  for (;;) {
    char head[8];  // length, type
    if (!read_exactly(file, head, sizeof(head))) return kCutShort;
    const std::string_view type(head + 4, 4);
    const bool is_allowed = order.allows(type, big_endian(head));
    std::string fault = read_chunk(file, head, block, [&](const char* bytes, size_t count) {
      if (type == "IDAT") texels.add(bytes, count);
    });
    if (!fault.empty()) return fault;
    if (!is_allowed) return "is damaged (a chunk that does not belong there), expected a whole PNG";
    if (type == "IEND") return texels.fault();
  }
}

}  // namespace hemibake
