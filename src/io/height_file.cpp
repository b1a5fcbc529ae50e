#include "io/height_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "core/error.h"
#include "io/channel_survey.h"
#include "io/geo_read.h"
#include "io/height_sink.h"
#include "io/image_reader.h"
#include "io/npy_file.h"
#include "io/pnm_file.h"
#include "io/raw_file.h"
#include "io/split_heights.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

// Where alpha is 0 or full in fewer texels (percent), it is no mask but data of its own.
constexpr size_t kLeastMaskPercent = 90;

// Collects alpha; its zeros are holes where it is a mask.
class AlphaMask {
 public:
  AlphaMask(int width, int height) : is_zero_(width, height, uint8_t{0}) {}

  void put(size_t texel, float alpha) {
    is_zero_[texel] = alpha == 0;
    zeros_ += is_zero_[texel];
    full_ += alpha == 1;
  }

  void mark_holes(HeightSink& sink) const {
    const size_t count = is_zero_.size();
    if (zeros_ == 0 || zeros_ == count || 100 * (zeros_ + full_) < kLeastMaskPercent * count) return;
    for (size_t i = 0; i < count; ++i)
      if (is_zero_[i]) sink.mark_hole(i);
  }

 private:
  Grid<uint8_t> is_zero_;
  size_t zeros_ = 0, full_ = 0;
};

// Says which channels of an image vary.
class ChannelRanges {
 public:
  explicit ChannelRanges(ChannelReader& reader) {
    const size_t channels = reader.facts().channels.size();
    reader.read(0, static_cast<int>(channels), [&](size_t, std::span<const float> values) {
      if (first_.empty()) {
        first_.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(channels));
        varies_.assign(channels, false);
        is_mask_.assign(channels, true);
      }
      for (size_t i = 0; i < values.size(); ++i) {
        const size_t c = i % channels;
        if (values[i] != first_[c]) varies_[c] = true;
        if (values[i] != 0 && values[i] != 1) is_mask_[c] = false;
      }
    });
  }

  // Returns the channels that vary: colours and layers, else an alpha that is no mask.
  std::vector<int> varying(std::optional<int> alpha) const {
    std::vector<int> found;
    for (size_t c = 0; c < varies_.size(); ++c)
      if (varies_[c] && static_cast<int>(c) != alpha) found.push_back(static_cast<int>(c));
    if (found.empty() && alpha && varies_[static_cast<size_t>(*alpha)] &&
        !is_mask_[static_cast<size_t>(*alpha)])
      found.push_back(*alpha);
    return found;
  }

 private:
  std::vector<float> first_;
  std::vector<bool> varies_, is_mask_;
};

// The channels of one reading, by index; those that are not there are empty.
struct Taken {
  std::optional<int> height, red, green, blue, alpha;

  int begin() const {
    int low = std::numeric_limits<int>::max();
    for (const auto& c : {height, red, green, blue, alpha}) low = std::min(low, c.value_or(low));
    return low;
  }
  int end() const {
    int high = 0;
    for (const auto& c : {height, red, green, blue, alpha}) high = std::max(high, c.value_or(high));
    return high + 1;
  }
};

bool is_8_bit(const ChannelFacts& facts) {
  return facts.full_scale == 255 && facts.sample_type == "8-bit integers";
}

// What one reading found beside the heights.
struct Found {
  bool is_constant = true;
  std::string objection, doubt;
};

// Reads one channel into the sink; surveys the colours where it is green.
Found read_channel(ChannelReader& reader, const Taken& taken, HeightSink& sink) {
  const ChannelFacts& facts = reader.facts();
  const int begin = taken.begin(), end = taken.end();
  const auto channels = static_cast<size_t>(end - begin);
  const auto offset = [&](std::optional<int> c) { return static_cast<size_t>(c.value_or(begin) - begin); };
  const size_t height = offset(taken.height), red = offset(taken.red), green = offset(taken.green),
               blue = offset(taken.blue), alpha = offset(taken.alpha);
  const bool is_float = facts.sample_type.find("floats") != std::string::npos;
  ChannelSurvey survey(is_8_bit(facts), is_float);
  AlphaMask mask(taken.alpha ? reader.width() : 0, taken.alpha ? reader.height() : 0);
  std::optional<float> first_value;
  Found found;
  reader.read(begin, end, [&](size_t first, std::span<const float> values) {
    for (size_t i = 0; i < values.size() / channels; ++i) {
      const float* texel = &values[i * channels];
      const size_t at = reader.upright(first + i);
      const float value = texel[height];
      const double scaled = value * facts.full_scale;
      sink.put(at, is_float ? scaled : std::round(scaled), value);
      if (!first_value) first_value = value;
      if (value != *first_value) found.is_constant = false;
      if (taken.alpha) mask.put(at, texel[alpha]);
      if (taken.green && taken.alpha) survey.add_alpha(texel[green], texel[alpha]);
      if (taken.red && taken.green)
        survey.add(texel[red], texel[green], taken.blue ? texel[blue] : 0,
                   (first + i) % static_cast<size_t>(facts.width) == 0);
    }
  });
  if (taken.alpha) mask.mark_holes(sink);
  if (taken.red && taken.green) {
    found.objection = survey.objection();
    found.doubt = survey.doubt();
  }
  return found;
}

// Returns the only channel that varies where the default does not; none where all are constant. Throws
// InputError where several vary.
std::optional<int> other_channel(ChannelReader& reader, int chosen) {
  const ChannelFacts& facts = reader.facts();
  if (facts.channels.size() == 1) return std::nullopt;
  const std::vector<int> varying = ChannelRanges(reader).varying(facts.alpha);
  if (varying.empty()) return std::nullopt;
  if (varying.size() == 1) return varying[0];
  std::string names;
  for (const int c : varying) names += (names.empty() ? "" : ", ") + facts.channels[static_cast<size_t>(c)];
  reader.refuse(
      fmt::format("has the same value everywhere in channel {}, expected --channel to name the one "
                  "that holds the heights: {}",
                  facts.channels[static_cast<size_t>(chosen)], names));
}

void read_one_channel(ChannelReader& reader, const HeightFileOptions& options,
                      const std::optional<double>& no_data, HeightFile& file) {
  const ChannelFacts& facts = reader.facts();
  const std::optional<int> chosen = choose_channel(facts, options.channel);
  if (!chosen) refuse_channel(reader, options.channel);
  Taken taken{chosen, {}, {}, {}, facts.alpha};
  if (taken.alpha == chosen) taken.alpha.reset();
  const bool is_default = options.channel.empty();
  if (is_default && facts.channels[static_cast<size_t>(*chosen)] == "G") {
    taken.red = find_channel(facts.channels, "R");
    taken.green = chosen;
    taken.blue = find_channel(facts.channels, "B");
  }
  auto sink = std::make_unique<HeightSink>(reader.path(), reader.width(), reader.height(), no_data);
  const Found found = read_channel(reader, taken, *sink);
  if (is_default && found.is_constant)
    if (const std::optional<int> other = other_channel(reader, *chosen)) {
      taken = {other, {}, {}, {}, other == facts.alpha ? std::optional<int>() : facts.alpha};
      sink = std::make_unique<HeightSink>(reader.path(), reader.width(), reader.height(), no_data);
      read_channel(reader, taken, *sink);
    }
  if (!found.is_constant && !found.objection.empty()) reader.refuse(found.objection);
  if (!found.is_constant) file.doubt = found.doubt;
  file.channel = facts.channels[static_cast<size_t>(*taken.height)];
  sink->finish(file);
}

const char* encoding_name(SplitEncoding encoding) {
  return encoding == SplitEncoding::kTerrarium ? "terrarium"
         : encoding == SplitEncoding::kMapbox  ? "mapbox"
                                               : "rg16";
}

void read_split_channels(ChannelReader& reader, const HeightFileOptions& options,
                         const std::optional<double>& no_data, HeightFile& file) {
  const ChannelFacts& facts = reader.facts();
  const char* name = encoding_name(options.encoding);
  if (!options.channel.empty())
    reader.refuse(fmt::format("takes --encoding {} of several channels, expected no --channel", name));
  const Taken taken{{},
                    find_channel(facts.channels, "R"),
                    find_channel(facts.channels, "G"),
                    find_channel(facts.channels, "B"),
                    facts.alpha};
  const bool needs_blue = options.encoding != SplitEncoding::kRg16;
  if (!is_8_bit(facts) || !taken.red || !taken.green || (needs_blue && !taken.blue))
    reader.refuse(fmt::format("holds {} in {} channel(s), expected red, green{} of 8 bits for --encoding {}",
                              facts.sample_type, facts.channels.size(), needs_blue ? " and blue" : "", name));
  const int begin = taken.begin();
  const auto channels = static_cast<size_t>(taken.end() - begin);
  const auto byte = [&](const float* texel, std::optional<int> c) {
    return c ? std::round(255.0 * texel[*c - begin]) : 0;
  };
  const double scale = needs_blue ? 1 : 65535;
  HeightSink sink(reader.path(), reader.width(), reader.height(), no_data);
  AlphaMask mask(reader.width(), reader.height());
  reader.read(begin, taken.end(), [&](size_t first, std::span<const float> values) {
    for (size_t i = 0; i < values.size() / channels; ++i) {
      const float* texel = &values[i * channels];
      const double height = join_split_height(options.encoding, byte(texel, taken.red),
                                              byte(texel, taken.green), byte(texel, taken.blue));
      const size_t at = reader.upright(first + i);
      sink.put(at, height, static_cast<float>(height / scale));
      mask.put(at, taken.alpha ? texel[*taken.alpha - begin] : 1);
    }
  });
  mask.mark_holes(sink);
  file.channel = name;
  file.full_scale = scale;
  file.in_metres = needs_blue;
  sink.finish(file);
}

HeightFile read_channels(ChannelReader& reader, const HeightFileOptions& options) {
  const ChannelFacts& facts = reader.facts();
  HeightFile file;
  file.format = facts.format;
  file.sample_type = facts.sample_type;
  file.channels = facts.channels;
  file.full_scale = facts.full_scale;
  file.orientation = facts.orientation;
  file.pixel_aspect = facts.pixel_aspect;
  const std::optional<double> no_data = options.no_data ? options.no_data : facts.no_data;
  if (options.encoding == SplitEncoding::kNone)
    read_one_channel(reader, options, no_data, file);
  else
    read_split_channels(reader, options, no_data, file);
  return file;
}

// Throws InputError where another part than the only one is asked for.
void check_only_part(const fs::path& path, const HeightFileOptions& options) {
  if (options.part.value_or(0) != 0)
    throw InputError(fmt::format("{}: holds 1 image, counted from 0, expected it, not --part {}",
                                 path.string(), *options.part));
}

// Throws InputError for options that a file of one plain channel cannot follow.
void check_single_channel(const fs::path& path, const HeightFileOptions& options) {
  if (options.encoding != SplitEncoding::kNone)
    throw InputError(
        fmt::format("{}: has one channel, expected red, green and blue of 8 bits for --encoding {}",
                    path.string(), encoding_name(options.encoding)));
  if (!options.channel.empty() && options.channel != "0" && options.channel != "Y")
    throw InputError(
        fmt::format("{}: has one channel, expected no --channel '{}'", path.string(), options.channel));
}

HeightFile read_image(const fs::path& path, const HeightFileOptions& options) {
  std::error_code ignored;
  const bool is_file = fs::is_regular_file(path, ignored) && fs::file_size(path, ignored) > 0;
  if (is_file && is_raw_name(path))
    throw InputError(
        fmt::format("{}: has no header, expected --raw WxH:TYPE; {}", path.string(), raw_suggestion(path)));
  if (is_file && is_pnm_file(path)) {
    check_only_part(path, options);
    PnmReader reader(path);
    return read_channels(reader, options);
  }
  ImageReader reader(path, {options.part, options.window, true});
  return read_channels(reader, options);
}

}  // namespace

HeightFile read_height_file(const fs::path& path, const HeightFileOptions& options) {
  // Formats with a place on the earth come first: some are TIFFs.
  if (std::optional<HeightFile> terrain = read_geo_file(path, options)) return *std::move(terrain);
  std::error_code ignored;
  const bool is_file = fs::is_regular_file(path, ignored);
  if (is_file && (!options.raw.empty() || is_npy_file(path))) {
    check_single_channel(path, options);
    check_only_part(path, options);
    return options.raw.empty() ? read_npy_file(path, options.no_data)
                               : read_raw_file(path, options.raw, options.no_data);
  }
  return read_image(path, options);
}

}  // namespace hemibake
