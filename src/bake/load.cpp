#include "bake/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "bake/normal_reading.h"
#include "core/error.h"
#include "io/file_context.h"
#include "io/provenance.h"
#include "surface/holes.h"
#include "surface/normals.h"
#include "surface/square_texels.h"

namespace hemibake {
namespace {

// 8-bit values are this many steps.
constexpr double kStepsOfBytes = 255;

void append(std::vector<std::string>& warnings, std::vector<std::string> more) {
  std::ranges::move(more, std::back_inserter(warnings));
}

// Makes the surface; where values that stand out make it impossible, the error says so.
Surface make_surface_or_name(Grid<float> heights, const MapSettings& settings,
                             const std::vector<std::string>& outliers) {
  try {
    return make_surface(std::move(heights), *settings.size_m, *settings.amplitude_m, settings.edge);
  } catch (const InputError& error) {
    if (outliers.empty()) throw;
    throw SettingError(std::string(error.what()) + "; " + outliers[0]);
  }
}

// Fills the heights of a file's holes, or refuses them.
void fill_or_refuse_holes(const MapSettings& settings, HeightFile& file, MapReading& reading) {
  reading.holes = static_cast<size_t>(std::ranges::count(file.holes.values, uint8_t{1}));
  if (reading.holes == 0) return;
  if (settings.holes == Holes::kRefuse) {
    const auto first =
        static_cast<int>(std::ranges::find(file.holes.values, uint8_t{1}) - file.holes.values.begin());
    throw SettingError(fmt::format(
        "{} texels have no height (first {},{}), expected one in every texel, or {{holes}} fill or open",
        reading.holes, first % file.holes.width, first / file.holes.width));
  }
  fill_holes(file.holes, settings.edge, file.values);
}

// Returns the heights in square texels; the longer side and the place then are theirs.
Grid<float> squared(Grid<float> heights, const HeightUnits& units, LoadedMap& map) {
  MapSettings& settings = map.settings;
  if (settings.texel_m.empty()) return heights;
  if (settings.normals_from == NormalSource::kMap)
    throw SettingError(fmt::format(
        "texels of {:g} x {:g} m are resampled, which a normal map is not, expected none with them",
        units.texel_x_m, units.texel_y_m));
  SquareTexels square = make_texels_square(heights, units.texel_x_m, units.texel_y_m, settings.edge);
  settings.size_m = square.texel_m * std::max(square.heights.width, square.heights.height);
  if (map.place) {
    auto& t = map.place->transform;
    t[0] += (square.first_x + 0.5 - 0.5 * square.step_x) * t[1];
    t[3] += (square.first_y + 0.5 - 0.5 * square.step_y) * t[5];
    t[1] *= square.step_x;
    t[5] *= square.step_y;
  }
  return std::move(square.heights);
}

// Makes the surface of a file's heights, with central-difference normals, and tells what was understood.
// map.settings: as the user set them; resolved afterwards.
void make_surface_of(HeightFile file, LoadedMap& map) {
  MapSettings& settings = map.settings;
  MapReading& reading = map.reading;
  const std::vector<std::string> outliers = outlier_warnings(file, settings.heights == HeightUnit::kMetres);
  append(reading.warnings, outliers);
  if (!file.doubt.empty()) reading.warnings.push_back(file.doubt);
  fill_or_refuse_holes(settings, file, reading);
  reading.units = resolve_units(file, settings);
  const bool metres = settings.heights == HeightUnit::kMetres;
  if (file.full_scale == kStepsOfBytes) reading.step_m = *settings.amplitude_m / (metres ? 1 : kStepsOfBytes);
  map.place = file.place;
  Grid<uint8_t> holes = std::exchange(file.holes, {});
  const bool open = settings.holes == Holes::kOpen && reading.holes > 0;
  if (open && !settings.texel_m.empty())
    throw SettingError(fmt::format(
        "{{holes}}: texels of {:g} x {:g} m are resampled, which open holes are not, expected fill",
        reading.units.texel_x_m, reading.units.texel_y_m));
  Grid<float> heights = squared(std::exchange(file.values, {}), reading.units, map);
  reading.file = std::move(file);
  if (settings.filter.radius > 0) heights = bilateral_filter(heights, settings.filter, settings.edge);
  if (!metres) {
    map.amplitude_m = *settings.amplitude_m;
    map.lowest_m = map.amplitude_m * static_cast<double>(*std::ranges::min_element(heights.values));
  }
  map.surface = make_surface_or_name(std::move(heights), settings, outliers);
  if (open) map.surface.holes = std::move(holes);
  append(reading.warnings, surface_warnings(reading, settings, map.surface));
}

void take_normals(NormalLength lengths, LoadedMap& map) {
  if (map.settings.normals_from == NormalSource::kFaces)
    map.surface.normals = angle_weighted_normals(map.surface);
  if (map.settings.normals_from != NormalSource::kMap) return;
  ReadNormals read = read_normals(map.settings, map.surface);
  map.surface.normals = std::move(read.normals);
  if (lengths == NormalLength::kStored) map.normal_lengths = std::move(read.lengths);
  map.reading.normals = std::move(read.reading);
  for (const std::string& warning : read.warnings)
    map.reading.warnings.push_back(map.settings.normal_map.string() + ": " + warning);
}

}  // namespace

MapHashes hash_files(const MapSettings& settings) {
  MapHashes hashes{sha256_of_file(settings.map), ""};
  if (settings.normals_from == NormalSource::kMap) hashes.normal_map = sha256_of_file(settings.normal_map);
  return hashes;
}

LoadedMap load_map(const MapSettings& settings, NormalLength lengths) {
  LoadedMap map;
  map.settings = settings;
  HeightFile file = read_height_file(settings.map, settings.file);
  with_file_context(settings.map, [&] { make_surface_of(std::move(file), map); });
  take_normals(lengths, map);
  map.sha256 = hash_files(settings);
  return map;
}

}  // namespace hemibake
