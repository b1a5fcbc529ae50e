// Reads the channels of an image in blocks of rows, whatever its format.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/height_file.h"

namespace hemibake {

// What a file says about its channels.
struct ChannelFacts {
  int width = 0, height = 0;  // as stored; orientations from 5 on swap them
  std::vector<std::string> channels;
  std::optional<int> alpha;  // index
  std::string format, sample_type;
  double full_scale = 1;  // stored value that is 1 in memory
  int orientation = 1;    // 1..8 as EXIF counts them
  double pixel_aspect = 1;
  std::optional<double> no_data;  // stored value
};

// Receives texels in the order stored. first: index of the first texel; values: channels interleaved.
using BlockVisitor = std::function<void(size_t first, std::span<const float> values)>;

class ChannelReader {
 public:
  explicit ChannelReader(std::filesystem::path path) : path_(std::move(path)) {}
  virtual ~ChannelReader() = default;
  ChannelReader(const ChannelReader&) = delete;
  ChannelReader& operator=(const ChannelReader&) = delete;

  const std::filesystem::path& path() const { return path_; }
  const ChannelFacts& facts() const { return facts_; }

  // Size right way up.
  int width() const { return facts_.orientation > 4 ? facts_.height : facts_.width; }
  int height() const { return facts_.orientation > 4 ? facts_.width : facts_.height; }

  // Returns the index, right way up, of a texel as stored (EXIF 2.3, tag 274).
  size_t upright(size_t stored) const {
    if (facts_.orientation == 1) return stored;
    const auto w = static_cast<size_t>(facts_.width), h = static_cast<size_t>(facts_.height);
    const size_t x = stored % w, y = stored / w;
    switch (facts_.orientation) {
      case 2:
        return y * w + (w - 1 - x);
      case 3:
        return (h - 1 - y) * w + (w - 1 - x);
      case 4:
        return (h - 1 - y) * w + x;
      case 5:
        return x * h + y;
      case 6:
        return x * h + (h - 1 - y);
      case 7:
        return (w - 1 - x) * h + (h - 1 - y);
      case 8:
        return (w - 1 - x) * h + y;
      default:
        return stored;
    }
  }

  // Throws InputError where values of that many bytes a texel do not fit the memory that there is for them.
  void require_bytes_per_texel(double bytes) const;

  // Throws InputError of one line naming the file.
  [[noreturn]] void refuse(const std::string& fault) const;

  // Visits all texels with the channels [begin, end). Throws InputError where the file is cut short.
  virtual void read(int begin, int end, const BlockVisitor& visit) = 0;

 protected:
  ChannelFacts facts_;

 private:
  std::filesystem::path path_;
};

// Returns the index of the channel of that name, in any case where only one matches.
std::optional<int> find_channel(const std::vector<std::string>& channels, const std::string& name);

// Returns the index of the channel of that name or index; of no name: the only one beside alpha, else green
// (`G`), else the luminance (`Y`).
std::optional<int> choose_channel(const ChannelFacts& facts, const std::string& wanted);

// Throws InputError for a value that is not finite. texel: index right way up.
[[noreturn]] void refuse_value(const ChannelReader& reader, const std::string& channel, size_t texel,
                               float value);

// Throws InputError that lists the channels.
[[noreturn]] void refuse_channel(const ChannelReader& reader, const std::string& wanted);

}  // namespace hemibake
