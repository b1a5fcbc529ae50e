// Layout: netpbm.sourceforge.net/doc/pgm.html and ppm.html.
#include "io/pnm_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>

#include "core/context.h"
#include "io/input_file.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

bool is_space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

}  // namespace

bool is_pnm_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  char head[3];
  if (!file.read(head, sizeof(head))) return false;
  const bool is_kind = head[1] == '2' || head[1] == '3' || head[1] == '5' || head[1] == '6';
  return head[0] == 'P' && is_kind && (is_space(head[2]) || head[2] == '#');
}

PnmReader::PnmReader(const std::filesystem::path& path)
    : ChannelReader(path), bytes_(read_whole_file(path)), at_(2) {
  const char kind = bytes_.at(1);
  const bool is_color = kind == '3' || kind == '6';
  facts_.width = read_number();
  facts_.height = read_number();
  max_value_ = read_number();
  if (facts_.width < 1 || facts_.height < 1 || max_value_ < 1 || max_value_ > 65535)
    refuse(
        fmt::format("has a header of {} x {} texels with values to {}, expected at least one texel and "
                    "values to 1 .. 65535",
                    facts_.width, facts_.height, max_value_));
  const uint64_t texels = static_cast<uint64_t>(facts_.width) * static_cast<uint64_t>(facts_.height);
  if (texels > kMaxTexels)
    refuse(
        fmt::format("claims {} x {} texels, expected at most {}", facts_.width, facts_.height, kMaxTexels));
  is_text_ = kind == '2' || kind == '3';
  if (!is_text_) ++at_;  // one white space ends the header
  const uint64_t sample_bytes = max_value_ > 255 ? 2 : 1;
  if (at_ + texels * (is_color ? 3 : 1) * (is_text_ ? 1 : sample_bytes) > bytes_.size())
    refuse(fmt::format("is cut short, expected {} x {} texels", facts_.width, facts_.height));
  facts_.channels = is_color ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
  facts_.format = is_color ? "PPM" : "PGM";
  facts_.sample_type = fmt::format("{}-bit integers", 8 * sample_bytes);
  facts_.full_scale = max_value_;
}

// Returns the next number of text, past white space and comments; -1 where there is none.
int PnmReader::read_number() {
  for (; at_ < bytes_.size() && (is_space(bytes_[at_]) || bytes_[at_] == '#'); ++at_)
    if (bytes_[at_] == '#') at_ = std::min(bytes_.find('\n', at_), bytes_.size() - 1);
  int value = -1;
  for (; at_ < bytes_.size() && std::isdigit(static_cast<unsigned char>(bytes_[at_])); ++at_) {
    value = 10 * std::max(value, 0) + (bytes_[at_] - '0');
    if (value > 100'000'000) return -1;
  }
  return value;
}

int PnmReader::read_sample() {
  if (is_text_) return read_number();
  int value = static_cast<uint8_t>(bytes_[at_++]);
  if (max_value_ > 255) value = value << 8 | static_cast<uint8_t>(bytes_[at_++]);
  return value;
}

void PnmReader::read(int begin, int end, const BlockVisitor& visit) {
  const size_t start = at_;
  const auto width = static_cast<size_t>(facts_.width);
  const auto channels = static_cast<int>(facts_.channels.size());
  std::vector<float> row(width * static_cast<size_t>(end - begin));
  for (int y = 0; y < facts_.height; ++y) {
    throw_if_cancelled();
    size_t filled = 0;
    for (size_t x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        const int value = read_sample();
        if (value < 0 || value > max_value_)
          refuse(fmt::format("has {} at texel {},{}, expected 0 to {}",
                             value < 0 ? "no number" : fmt::format("value {}", value), x, y, max_value_));
        if (c >= begin && c < end)
          row[filled++] = static_cast<float>(static_cast<double>(value) / max_value_);
      }
    }
    visit(static_cast<size_t>(y) * width, row);
  }
  at_ = start;
}

}  // namespace hemibake
