#include "cli/print/map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "bake/normal_reading.h"
#include "core/error.h"

namespace hemibake {
namespace {

constexpr std::array kEdgeNames = {"wrap", "open", "ground"};
constexpr std::array kHeightNames = {"metres", "unit"};
constexpr std::array kSourceNames = {"heights", "faces", "map"};
constexpr std::array kEncodingNames = {"linear", "signed", "srgb"};
constexpr std::array kNormalYSourceNames = {"said", "file", "heights"};
constexpr std::array kReasonNames = {"said",
                                     "terrain",
                                     "signed integers",
                                     "floats that range over more than 2",
                                     "amplitude given for floats that range over more than 2",
                                     "default"};
// Steps of the heights from which they are worth a word, in texels, and the rms error of AO that they make
// (src/bake/README.md).
constexpr double kCoarseStepTexels = 0.1, kErrorOfBytes = 0.008;

template <class Names, class Enum>
const char* name_in(const Names& names, Enum value) {
  return names.at(static_cast<size_t>(value));
}

bool is_coarse(const MapReading& reading) {
  return reading.step_m > kCoarseStepTexels * std::min(reading.units.texel_x_m, reading.units.texel_y_m);
}

std::string describe_file(const HeightFile& file) {
  std::string text = file.format.empty() ? "image" : file.format;
  if (!file.sample_type.empty()) text += ", " + file.sample_type;
  if (file.channels.size() > 1)
    text += fmt::format(", {} of {}", file.channel, fmt::join(file.channels, ", "));
  if (file.orientation != 1) text += fmt::format(", orientation {} applied", file.orientation);
  return text;
}

std::string describe_texel(const HeightUnits& units) {
  const bool square = std::abs(units.texel_x_m / units.texel_y_m - 1) < 1e-6;
  return (square ? fmt::format("{:.4g} m", units.texel_x_m)
                 : fmt::format("{:.4g} x {:.4g} m", units.texel_x_m, units.texel_y_m)) +
         (units.texel_from_file        ? " (of the file)"
          : units.texel_overrides_file ? " (not as the file says)"
                                       : "");
}

std::string describe_values(const LoadedMap& map) {
  const HeightUnits& units = map.reading.units;
  std::string text = fmt::format("{:.4g} to {:.4g}", units.stored_low, units.stored_high);
  if (map.settings.heights == HeightUnit::kMetres || units.reason != UnitReason::kDefault)
    text += fmt::format(" ({}: {})", map.settings.heights == HeightUnit::kMetres ? "metres" : "not metres",
                        units.reason == UnitReason::kSaid ? "as said" : name_in(kReasonNames, units.reason));
  return text;
}

std::string describe_normals(const LoadedMap& map) {
  const NormalReading& normals = *map.reading.normals;
  std::string text =
      fmt::format("normals   {} of {}, {}, y {} ({}), correlation with the heights {}",
                  fmt::join(normals.channels, ", "), map.settings.normal_map.string(),
                  name_in(kEncodingNames, normals.encoding), normals.y == NormalY::kUp ? "up" : "down",
                  normals.y_from == NormalYSource::kSaid   ? "as said"
                  : normals.y_from == NormalYSource::kFile ? "as the file says"
                                                           : "as fits the heights",
                  agreement_text(normals.agreement));
  if (normals.agreement.slope_ratio)
    text += fmt::format(", slopes {:.3g} times theirs", *normals.agreement.slope_ratio);
  return text + "\n";
}

nlohmann::ordered_json json_or_null(const std::optional<double>& value) {
  return value ? nlohmann::ordered_json(*value) : nullptr;
}

nlohmann::ordered_json json_from_normals(const LoadedMap& map) {
  nlohmann::ordered_json json = {{"source", name_in(kSourceNames, map.settings.normals_from)}};
  if (!map.reading.normals) return json;
  const NormalReading& normals = *map.reading.normals;
  json["channels"] = normals.channels;
  json["encoding"] = name_in(kEncodingNames, normals.encoding);
  json["y"] = normals.y == NormalY::kUp ? "up" : "down";
  json["y_from"] = name_in(kNormalYSourceNames, normals.y_from);
  json["mean_length"] = normals.mean_length;
  json["correlation_x"] = json_or_null(normals.agreement.x);
  json["correlation_y"] = json_or_null(normals.agreement.y);
  json["slope_ratio"] = json_or_null(normals.agreement.slope_ratio);
  return json;
}

}  // namespace

std::string describe_map(const LoadedMap& map) {
  const MapReading& reading = map.reading;
  std::string text = fmt::format("map       {}: {}, heights {:.4g} to {:.4g} m over texels of {}, {}",
                                 describe_file(reading.file), describe_values(map), reading.units.lowest_m,
                                 reading.units.highest_m, describe_texel(reading.units),
                                 name_in(kEdgeNames, map.settings.edge));
  if (!map.settings.texel_m.empty())
    text += fmt::format(", made square: {} x {}", map.surface.width(), map.surface.height());
  if (reading.holes > 0)
    text += fmt::format(", {} holes {}", reading.holes,
                        map.settings.holes == Holes::kOpen ? "open: rays see sky through them" : "filled");
  if (is_coarse(reading))
    text += fmt::format(", steps of {:.2g} m (8 bits: AO may be off by {:g})", reading.step_m, kErrorOfBytes);
  if (reading.normals) return text + "\n" + describe_normals(map);
  return text + fmt::format(", normals of the {}\n", name_in(kSourceNames, map.settings.normals_from));
}

nlohmann::ordered_json json_from_map(const LoadedMap& map) {
  const HeightFile& file = map.reading.file;
  const HeightUnits& units = map.reading.units;
  nlohmann::ordered_json json = {{"format", file.format},
                                 {"sample_type", file.sample_type},
                                 {"channels", file.channels},
                                 {"channel", file.channel},
                                 {"orientation", file.orientation},
                                 {"pixel_aspect", file.pixel_aspect},
                                 {"low_value", units.stored_low},
                                 {"high_value", units.stored_high},
                                 {"heights", name_in(kHeightNames, *map.settings.heights)},
                                 {"heights_because", name_in(kReasonNames, units.reason)},
                                 {"lowest_m", units.lowest_m},
                                 {"highest_m", units.highest_m},
                                 {"texel_x_m", units.texel_x_m},
                                 {"texel_y_m", units.texel_y_m},
                                 {"texel_from_file", units.texel_from_file},
                                 {"edge", name_in(kEdgeNames, map.settings.edge)},
                                 {"holes", map.reading.holes},
                                 {"step_m", map.reading.step_m}};
  json["normals"] = json_from_normals(map);
  return json;
}

std::vector<std::string> warnings_of(const LoadedMap& map) {
  std::vector<std::string> warnings;
  for (const std::string& warning : map.reading.warnings)
    warnings.push_back(SettingError(warning).with_prefix("--"));
  return warnings;
}

}  // namespace hemibake
