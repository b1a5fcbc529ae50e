#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "core/context.h"
#include "core/error.h"
#include "core/parallel.h"
#include "io/image_io.h"
#include "io/png_check.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Values (texels × channels) read at a time: a few MB, some compression blocks for the threads.
constexpr int64_t kValuesPerBlock = int64_t{1} << 21;
constexpr int kMaxRowsPerBlock = 64;

// Joins the lines of a message of OpenImageIO.
std::string one_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

[[noreturn]] void refuse(const fs::path& path, const std::string& fault) {
  throw InputError(fmt::format("{}: {}", path.string(), fault));
}

void check_regular_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) refuse(path, error.message() + ", expected an image");
  if (fs::is_directory(status)) refuse(path, "is a folder, expected an image");
  if (!fs::is_regular_file(status)) refuse(path, "is not a regular file, expected an image");
  if (fs::file_size(path, error) == 0 && !error) refuse(path, "is empty, expected an image");
}

void check_usable(const fs::path& path, const OIIO::ImageSpec& spec) {
  const auto texels =
      static_cast<uint64_t>(std::max(0, spec.width)) * static_cast<uint64_t>(std::max(0, spec.height));
  if (texels == 0 || spec.nchannels < 1)
    refuse(path, fmt::format("holds {} x {} texels, expected at least one", spec.width, spec.height));
  if (texels > kMaxTexels)
    refuse(path,
           fmt::format("claims {} x {} texels, expected at most {}", spec.width, spec.height, kMaxTexels));
  if (spec.deep) refuse(path, "is a deep image, expected one value per texel and channel");
  if (spec.depth > 1)
    refuse(path, fmt::format("is a volume of {} slices, expected a flat image", spec.depth));
}

void check_windows(const fs::path& path, const OIIO::ImageSpec& spec) {
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width ||
      spec.height != spec.full_height)
    refuse(path,
           fmt::format("has a data window of {} x {} at ({}, {}) in a display window of {} x {} at ({}, {}), "
                       "expected the same window for both",
                       spec.width, spec.height, spec.x, spec.y, spec.full_width, spec.full_height,
                       spec.full_x, spec.full_y));
}

// Refuses TIFFs that OpenImageIO 2.4 reads wrongly without an error (tiffinput.cpp: unusual depths stay in a
// scratch buffer, and only 8-bit values are inverted).
void check_tiff(const fs::path& path, const OIIO::ImageSpec& spec) {
  const int bits = spec.get_int_attribute("oiio:BitsPerSample");
  if (spec.format.is_floating_point() && bits != 16 && bits != 32)
    refuse(path, fmt::format("holds {}-bit floats, which cannot be read, expected 32-bit floats", bits));
  constexpr int kMinIsWhite = 0;
  if (spec.get_int_attribute("tiff:PhotometricInterpretation", 1) == kMinIsWhite &&
      spec.format != OIIO::TypeDesc::UINT8)
    refuse(path, "stores white as the least value in more than 8 bits, expected black there");
}

// An open image that passed every check that the header allows.
class Reader {
 public:
  explicit Reader(const fs::path& path) : path_(path) {
    check_regular_file(path);
    if (const std::string fault = png_error(path); !fault.empty()) refuse(path, fault);
    OIIO::attribute("threads", thread_count());
    OIIO::attribute("exr_threads", thread_count());
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    input_ = OIIO::ImageInput::open(path.string(), &hints);
    if (!input_)
      refuse(path, fmt::format("is not an image that can be read ({})", one_line(OIIO::geterror())));
    spec_ = input_->spec();
    check_usable(path, spec_);
    const std::string_view format = input_->format_name();
    if (format == "openexr") check_windows(path, spec_);
    if (format == "tiff") check_tiff(path, spec_);
    if (input_->seek_subimage(1, 0)) refuse(path, "holds several images, expected one");
    input_->geterror();  // clears the error of seeking
  }

  const OIIO::ImageSpec& spec() const { return spec_; }

  [[noreturn]] void refuse_image(const std::string& fault) const { refuse(path_, fault); }

  // Fills planes[k] from channel indices[k], all in one pass.
  void read(std::span<const MutablePlane> planes, std::span<const int> indices) {
    const auto [low, high] = std::minmax_element(indices.begin(), indices.end());
    const bool integers = spec_.format == OIIO::TypeDesc::UINT8 || spec_.format == OIIO::TypeDesc::UINT16;
    if (integers) {
      // 8 bits widen to 16 exactly (v · 257), so that one division gives the nearest float for both.
      read_blocks<uint16_t>(planes, indices, *low, *high + 1, OIIO::TypeDesc::UINT16,
                            [](uint16_t value) { return static_cast<float>(value / 65535.0); });
    } else {
      read_blocks<float>(planes, indices, *low, *high + 1, OIIO::TypeDesc::FLOAT,
                         [](float value) { return value; });
    }
  }

 private:
  int rows_per_block(int channels) const {
    if (spec_.tile_width > 0) return spec_.tile_height;
    return static_cast<int>(
        std::clamp<int64_t>(kValuesPerBlock / (int64_t{spec_.width} * channels), 1, kMaxRowsPerBlock));
  }

  bool read_rows(int begin, int end, int channel_begin, int channel_end, OIIO::TypeDesc format,
                 void* values) {
    if (spec_.tile_width > 0)
      return input_->read_tiles(0, 0, spec_.x, spec_.x + spec_.width, spec_.y + begin, spec_.y + end, spec_.z,
                                spec_.z + 1, channel_begin, channel_end, format, values);
    return input_->read_scanlines(0, 0, spec_.y + begin, spec_.y + end, spec_.z, channel_begin, channel_end,
                                  format, values);
  }

  template <class Sample, class Convert>
  void read_blocks(std::span<const MutablePlane> planes, std::span<const int> indices, int channel_begin,
                   int channel_end, OIIO::TypeDesc format, Convert convert) {
    const int channels = channel_end - channel_begin;
    const int rows = rows_per_block(channels);
    std::vector<Sample> block(static_cast<size_t>(rows) * static_cast<size_t>(spec_.width) *
                              static_cast<size_t>(channels));
    for (int begin = 0; begin < spec_.height; begin += rows) {
      throw_if_cancelled();
      const int end = std::min(spec_.height, begin + rows);
      if (!read_rows(begin, end, channel_begin, channel_end, format, block.data()) || input_->has_error())
        refuse(path_, fmt::format("cannot be read from row {} on, it may be cut short ({})", begin,
                                  one_line(input_->geterror())));
      const size_t first_texel = static_cast<size_t>(begin) * static_cast<size_t>(spec_.width);
      const size_t texels = static_cast<size_t>(end - begin) * static_cast<size_t>(spec_.width);
      for (size_t k = 0; k < planes.size(); ++k) {
        const auto offset = static_cast<size_t>(indices[k] - channel_begin);
        for (size_t i = 0; i < texels; ++i) {
          const float value = convert(block[i * static_cast<size_t>(channels) + offset]);
          if (!std::isfinite(value)) refuse_value(planes[k].channel, first_texel + i, value);
          planes[k].first[(first_texel + i) * planes[k].stride] = value;
        }
      }
    }
  }

  [[noreturn]] void refuse_value(const std::string& channel, size_t texel, float value) const {
    const auto width = static_cast<size_t>(spec_.width);
    refuse(path_, fmt::format("channel {} is {} at texel {},{}, expected a finite number", channel, value,
                              texel % width, texel / width));
  }

  fs::path path_;
  std::unique_ptr<OIIO::ImageInput> input_;
  OIIO::ImageSpec spec_;
};

// Returns the index of the channel of that name, in any case where only one matches.
std::optional<int> find_channel(const std::vector<std::string>& channels, const std::string& name) {
  const auto exact = std::find(channels.begin(), channels.end(), name);
  if (exact != channels.end()) return static_cast<int>(exact - channels.begin());
  const auto alike = [&](const std::string& channel) { return OIIO::Strutil::iequals(channel, name); };
  if (std::count_if(channels.begin(), channels.end(), alike) != 1) return std::nullopt;
  return static_cast<int>(std::find_if(channels.begin(), channels.end(), alike) - channels.begin());
}

std::optional<int> parse_index(const std::string& text, int count) {
  int index = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size() || index < 0 || index >= count)
    return std::nullopt;
  return index;
}

// Chooses as read_height_map says.
std::optional<int> choose_channel(const std::vector<std::string>& channels, const std::string& wanted) {
  if (!wanted.empty()) {
    const std::optional<int> named = find_channel(channels, wanted);
    return named ? named : parse_index(wanted, static_cast<int>(channels.size()));
  }
  if (channels.size() == 1) return 0;
  const std::optional<int> green = find_channel(channels, "G");
  return green ? green : find_channel(channels, "Y");
}

// Returns the index of the channel that `wanted` chooses.
int require_channel(const Reader& reader, const std::string& wanted) {
  const std::vector<std::string>& channels = reader.spec().channelnames;
  const std::optional<int> chosen = choose_channel(channels, wanted);
  if (!chosen)
    reader.refuse_image(fmt::format("has {}, expected the name or index of one of its channels: {}",
                                    wanted.empty() ? "no channel G" : fmt::format("no channel '{}'", wanted),
                                    fmt::join(channels, ", ")));
  return *chosen;
}

// Returns the indices of the channels that hold normals, as read_normal_map says.
std::vector<int> normal_channels(const std::vector<std::string>& channels) {
  const auto x = find_channel(channels, "normal.X"), y = find_channel(channels, "normal.Y"),
             z = find_channel(channels, "normal.Z");
  return x && y && z ? std::vector{*x, *y, *z} : std::vector{0, 1, 2};
}

// Returns what a TIFF of this program says, in the one text that the format has; null for any other.
Provenance provenance_in_description(const OIIO::ImageSpec& spec) {
  const std::string text(spec.get_string_attribute("ImageDescription"));
  Provenance provenance = Provenance::parse(text, nullptr, false);
  return provenance.is_object() && provenance.contains("texture") ? provenance : Provenance();
}

}  // namespace

ImageHeader read_image_header(const fs::path& path) {
  const Reader reader(path);
  const OIIO::ImageSpec& spec = reader.spec();
  ImageHeader header{spec.width, spec.height, spec.channelnames, nullptr};
  const std::string text(spec.get_string_attribute("hemibake:provenance"));
  header.provenance = Provenance::parse(text.empty() ? "null" : text, nullptr, false);
  if (header.provenance.is_discarded()) reader.refuse_image("attribute hemibake:provenance is not JSON");
  if (text.empty()) header.provenance = provenance_in_description(spec);
  return header;
}

void read_planes(const fs::path& path, int width, int height, std::span<const MutablePlane> planes) {
  Reader reader(path);
  const OIIO::ImageSpec& spec = reader.spec();
  if (spec.width != width || spec.height != height)
    reader.refuse_image(
        fmt::format("is {} x {} texels, expected {} x {}", spec.width, spec.height, width, height));
  std::vector<int> indices;
  for (const MutablePlane& plane : planes) {
    const auto found = std::find(spec.channelnames.begin(), spec.channelnames.end(), plane.channel);
    if (found == spec.channelnames.end())
      reader.refuse_image(
          fmt::format("has no channel '{}', only {}", plane.channel, fmt::join(spec.channelnames, ", ")));
    indices.push_back(static_cast<int>(found - spec.channelnames.begin()));
  }
  if (!planes.empty()) reader.read(planes, indices);
}

Grid<float> read_height_map(const fs::path& path, const std::string& channel) {
  Reader reader(path);
  const OIIO::ImageSpec& spec = reader.spec();
  const int chosen = require_channel(reader, channel);
  Grid<float> heights(spec.width, spec.height);
  const MutablePlane plane{spec.channelnames[static_cast<size_t>(chosen)], heights.values.data()};
  reader.read({&plane, 1}, {&chosen, 1});
  return heights;
}

NormalImage read_normal_map(const fs::path& path, int width, int height,
                            const std::vector<std::string>& channels) {
  Reader reader(path);
  const OIIO::ImageSpec& spec = reader.spec();
  if (spec.width != width || spec.height != height)
    reader.refuse_image(fmt::format("is {} x {} texels, expected {} x {} as the height map is", spec.width,
                                    spec.height, width, height));
  if (channels.empty() && spec.nchannels < 3)
    reader.refuse_image(fmt::format("has {} channel(s), expected the three of a normal map", spec.nchannels));
  NormalImage image{Grid<glm::vec3>(width, height, glm::vec3(0)), !spec.format.is_floating_point(), {}};
  std::vector<int> indices = channels.empty() ? normal_channels(spec.channelnames) : std::vector<int>();
  for (const std::string& channel : channels) indices.push_back(require_channel(reader, channel));
  std::vector<MutablePlane> planes;
  for (size_t c = 0; c < indices.size(); ++c) {
    image.channels.push_back(spec.channelnames[static_cast<size_t>(indices[c])]);
    planes.push_back({image.channels.back(), &image.values.values[0][static_cast<int>(c)], 3});
  }
  reader.read(planes, indices);
  return image;
}

ColorImage read_color_image(const fs::path& path) {
  Reader reader(path);
  const OIIO::ImageSpec& spec = reader.spec();
  ColorImage image{Grid<glm::vec3>(spec.width, spec.height), !spec.format.is_floating_point()};
  std::vector<MutablePlane> planes;
  std::vector<int> indices;
  for (int c = 0; c < 3; ++c) {
    indices.push_back(spec.nchannels < 3 ? 0 : c);
    planes.push_back({spec.channelnames[static_cast<size_t>(indices.back())], &image.colors.values[0][c], 3});
  }
  reader.read(planes, indices);
  return image;
}

}  // namespace hemibake
