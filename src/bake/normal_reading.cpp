#include "bake/normal_reading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "core/error.h"
#include "io/file_context.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

// Correlation from which a map's slopes follow the heights', and one that settles which channels they are.
constexpr double kFollows = 0.3, kFollowsWell = 0.5;
// Floats below this prove that −1..1 is stored.
constexpr float kProvesSigned = -0.01f;
// Mean error of the vectors' lengths up to which they are unit vectors (8 bits: 0.005), and above which they
// are none.
constexpr double kUnitLengthError = 0.05, kNoLengthError = 0.25;
// Slope ratio from which size or amplitude do not fit the normal map.
constexpr double kRatioTooLarge = 3;
constexpr float kFlatComponent = 0.01f;

struct ChannelChoice {
  std::vector<std::string> names;  // empty: as read_normal_map chooses
  std::array<bool, 3> negated{};
};

// Reads "X,Y[,Z]" with minus signs.
ChannelChoice choose_channels(const std::string& text) {
  ChannelChoice choice;
  if (text.empty()) return choice;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find(',', begin), text.size());
    std::string name = text.substr(begin, end - begin);
    const bool negated = name.starts_with('-');
    if (negated) name.erase(0, 1);
    if (choice.names.size() < 3) choice.negated[choice.names.size()] = negated;
    choice.names.push_back(std::move(name));
    begin = end + 1;
  }
  const bool is_named = std::ranges::none_of(choice.names, &std::string::empty);
  if (!is_named || choice.names.size() < 2 || choice.names.size() > 3)
    throw SettingError(
        fmt::format("{{normal-channels}}: '{}', expected two or three channels as R,G,B or A,G", text));
  return choice;
}

double mean_length_error(const Grid<float>& lengths) {
  double sum = 0;
  for (const float length : lengths.values) sum += std::abs(static_cast<double>(length) - 1);
  return sum / static_cast<double>(lengths.size());
}

double mean_length_error(const NormalImage& image, NormalDecoding decoding, NormalEncoding encoding) {
  decoding.encoding = encoding;
  return mean_length_error(normal_map_lengths(image.values, decoding));
}

// Returns how floats are stored by their values, kLinear for integers.
NormalEncoding encoding_of(const NormalImage& image, const NormalDecoding& decoding) {
  if (image.stored_as_integers) return NormalEncoding::kLinear;
  for (const glm::vec3& value : image.values.values)
    if (std::min({value.x, value.y, value.z}) < kProvesSigned) return NormalEncoding::kSigned;
  if (!decoding.has_z) return NormalEncoding::kLinear;
  const double as_signed = mean_length_error(image, decoding, NormalEncoding::kSigned);
  const double as_linear = mean_length_error(image, decoding, NormalEncoding::kLinear);
  return as_signed < kUnitLengthError && as_linear > 2 * kUnitLengthError ? NormalEncoding::kSigned
                                                                          : NormalEncoding::kLinear;
}

// Returns the direction of y that a file of this program records.
std::optional<NormalY> recorded_normal_y(const Provenance& made, const std::vector<std::string>& channels) {
  if (!made.is_object()) return std::nullopt;
  if (const auto green = made.find("green"); green != made.end())
    return *green == "up" ? NormalY::kUp : NormalY::kDown;
  const bool is_plane = made.contains("tracer") && channels[0] == "normal.X";
  return is_plane ? std::optional(NormalY::kDown) : std::nullopt;
}

const char* name_of(NormalY y) { return y == NormalY::kUp ? "up" : "down"; }
NormalY other(NormalY y) { return y == NormalY::kUp ? NormalY::kDown : NormalY::kUp; }

// Returns the direction of y in which the map follows the heights.
// follows: correlation of its y, read as down.
std::optional<NormalY> fitting_normal_y(const std::optional<double>& follows,
                                        const Grid<glm::vec3>& normals) {
  if (follows && std::abs(*follows) > kFollows) return *follows > 0 ? NormalY::kDown : NormalY::kUp;
  const bool is_flat = std::ranges::all_of(
      normals.values, [](const glm::vec3& normal) { return std::abs(normal.y) <= kFlatComponent; });
  return is_flat ? std::optional(NormalY::kUp) : std::nullopt;
}

// Decides reading.y from what is said, what the file records and the heights.
void resolve_y(const MapSettings& settings, std::optional<NormalY> recorded, std::optional<NormalY> fitting,
               NormalReading& reading) {
  if (recorded) {
    if (settings.normal_y && *settings.normal_y != *recorded)
      throw SettingError(fmt::format(
          "records that its y is {0}, expected no {{normal-y}} or {{normal-y}} {0}", name_of(*recorded)));
    reading.y_from = NormalYSource::kFile;
    reading.y = *recorded;
  } else if (settings.normal_y) {
    reading.y = *settings.normal_y;
  } else if (settings.decide_normal_y) {
    if (!fitting)
      throw SettingError(
          "{normal-y} auto: its y does not follow the heights, expected {normal-y} up or {normal-y} down");
    reading.y_from = NormalYSource::kHeights;
    reading.y = *fitting;
  } else {
    throw SettingError(fmt::format(
        "the direction of its green channel is not known, expected {{normal-y}} up or {{normal-y}} down{}",
        fitting ? fmt::format(" ({} fits the heights)", name_of(*fitting)) : ""));
  }
}

bool is_above(const std::optional<double>& value, double limit) { return value && *value > limit; }
bool is_below(const std::optional<double>& value, double limit) { return value && *value < -limit; }

// Returns the channels of four with which the map follows the heights: of a map whose x is in alpha, or whose
// x and y are exchanged. Empty: none.
std::string fitting_channels(const MapSettings& settings, const Surface& surface, NormalDecoding decoding) {
  const std::vector<std::string> channels = read_image_header(settings.normal_map).channels;
  const std::vector<std::pair<size_t, size_t>> candidates = {{3, 1}, {1, 0}, {0, 1}};
  decoding.has_z = false;
  decoding.negated = {};
  for (const auto& [x, y] : candidates) {
    if (std::max(x, y) >= channels.size()) continue;
    const std::vector<std::string> names = {channels[x], channels[y]};
    const NormalImage image = read_normal_map(settings.normal_map, surface.width(), surface.height(), names);
    const SlopeAgreement agreement =
        compare_slopes(decode_normal_map(image.values, decoding), surface.normals);
    if (is_above(agreement.x, kFollowsWell) && (!agreement.y || std::abs(*agreement.y) > kFollowsWell))
      return fmt::format("{}", fmt::join(names, ","));
  }
  return "";
}

// Decodes; an error says which channels would do, where some would.
Grid<glm::vec3> decode(const NormalImage& image, const NormalDecoding& decoding, const MapSettings& settings,
                       const Surface& surface) {
  try {
    return decode_normal_map(image.values, decoding);
  } catch (const InputError& error) {
    const std::string fitting =
        settings.normal_channels.empty() ? fitting_channels(settings, surface, decoding) : "";
    if (fitting.empty()) throw;
    throw SettingError(fmt::format("{}; its channels {} follow the heights, expected {{normal-channels}} {}",
                                   error.what(), fitting, fitting));
  }
}

// Returns a warning about lengths that are none of unit vectors.
std::string length_warning(const NormalImage& image, const NormalDecoding& decoding,
                           const NormalReading& reading, double error) {
  if (decoding.encoding == NormalEncoding::kLinear && error > kUnitLengthError &&
      mean_length_error(image, decoding, NormalEncoding::kSrgb) < error / 3)
    return fmt::format(
        "looks sRGB-encoded (mean length {:.3f} as stored, near 1 without the curve of sRGB): expected "
        "{{normal-encoding}} srgb",
        reading.mean_length);
  if (error > kNoLengthError)
    return fmt::format(
        "its vectors have a mean length of {:.3f} instead of 1: expected a normal map, or other "
        "{{normal-channels}} or {{normal-encoding}}",
        reading.mean_length);
  return "";
}

// Returns a warning where the map's slopes are not those of the heights in direction.
std::string direction_warning(const NormalReading& reading, const MapSettings& settings,
                              const Surface& surface, const NormalDecoding& decoding) {
  const SlopeAgreement& a = reading.agreement;
  const std::string text = "correlation " + agreement_text(a);
  if (is_below(a.y, kFollows) && !is_below(a.x, kFollows))
    return fmt::format("its y leans against the heights ({}): expected {}", text,
                       reading.y_from == NormalYSource::kFile
                           ? "the normals of these heights"
                           : fmt::format("{{normal-y}} {}", name_of(other(reading.y))));
  if (is_below(a.x, kFollows) && is_below(a.y, kFollows))
    return fmt::format(
        "leans against the heights in x and y ({}): one of the two maps is upside down, expected {{low}} "
        "above "
        "{{high}} where black is the top",
        text);
  if (is_below(a.x, kFollows))
    return fmt::format("its x leans against the heights ({}): expected {{normal-channels}} -{}", text,
                       fmt::join(reading.channels, ","));
  const bool is_weak = (a.x || a.y) && !is_above(a.x, kFollows) && !is_above(a.y, kFollows);
  if (!is_weak) return "";
  const std::string fitting =
      settings.normal_channels.empty() ? fitting_channels(settings, surface, decoding) : "";
  if (fitting.empty())
    return fmt::format("hardly follows the heights ({}): is it of another map, or are its channels others?",
                       text);
  return fmt::format(
      "hardly follows the heights ({}), but its channels {} do: expected {{normal-channels}} {}", text,
      fitting, fitting);
}

// Returns a warning where the map's slopes are those of the heights but for a factor.
std::string steepness_warning(const NormalReading& reading, const MapSettings& settings) {
  const SlopeAgreement& a = reading.agreement;
  if (!is_above(a.x, kFollows) && !is_above(a.y, kFollows)) return "";
  const double ratio = a.slope_ratio.value_or(1);
  if (ratio <= kRatioTooLarge && ratio >= 1 / kRatioTooLarge) return "";
  const std::string fitting = settings.heights == HeightUnit::kMetres || settings.high_m
                                  ? fmt::format("{{size}} {:.3g}", *settings.size_m / ratio)
                                  : fmt::format("{{amplitude}} {:.3g} or {{size}} {:.3g}",
                                                *settings.amplitude_m * ratio, *settings.size_m / ratio);
  return fmt::format(
      "its slopes are {:.3g} times those of the heights: expected {} if it is of these heights", ratio,
      fitting);
}

// Collects the warnings about a map that was decoded.
void add_warnings(const NormalImage& image, const NormalDecoding& decoding, const MapSettings& settings,
                  const Surface& surface, ReadNormals& read) {
  const double error = mean_length_error(read.lengths);
  std::string of_length = decoding.has_z ? length_warning(image, decoding, read.reading, error) : "";
  for (const std::string& warning : {of_length, direction_warning(read.reading, settings, surface, decoding),
                                     of_length.empty() ? steepness_warning(read.reading, settings) : ""})
    if (!warning.empty()) read.warnings.push_back(warning);
}

ReadNormals decode_and_compare(const NormalImage& image, const ChannelChoice& channels,
                               std::optional<NormalY> recorded, MapSettings& settings,
                               const Surface& surface) {
  NormalDecoding decoding{.negated = channels.negated, .has_z = image.channels.size() > 2};
  decoding.encoding = settings.normal_encoding.value_or(encoding_of(image, decoding));
  ReadNormals read;
  read.normals = decode(image, decoding, settings, surface);
  read.lengths = normal_map_lengths(image.values, decoding);
  read.reading.channels = image.channels;
  read.reading.encoding = decoding.encoding;
  for (const float length : read.lengths.values)
    read.reading.mean_length += (static_cast<double>(length) - 1) / static_cast<double>(read.lengths.size());
  read.reading.agreement = compare_slopes(read.normals, surface.normals);
  resolve_y(settings, recorded, fitting_normal_y(read.reading.agreement.y, read.normals), read.reading);
  if (read.reading.y == NormalY::kUp) {
    for (glm::vec3& normal : read.normals.values) normal.y = -normal.y;
    if (read.reading.agreement.y) *read.reading.agreement.y *= -1;
  }
  settings.normal_y = read.reading.y;
  settings.normal_encoding = decoding.encoding;
  add_warnings(image, decoding, settings, surface, read);
  return read;
}

}  // namespace

std::string agreement_text(const SlopeAgreement& agreement) {
  const auto text = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.2f}", *value) : "none";
  };
  return fmt::format("x {}, y {}", text(agreement.x), text(agreement.y));
}

ReadNormals read_normals(MapSettings& settings, const Surface& surface) {
  const std::filesystem::path& path = settings.normal_map;
  const ChannelChoice channels = choose_channels(settings.normal_channels);
  const NormalImage image = read_normal_map(path, surface.width(), surface.height(), channels.names);
  const std::optional<NormalY> recorded =
      channels.names.empty() ? recorded_normal_y(read_image_header(path).provenance, image.channels)
                             : std::nullopt;
  return with_file_context(path,
                           [&] { return decode_and_compare(image, channels, recorded, settings, surface); });
}

}  // namespace hemibake
