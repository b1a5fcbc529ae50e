#include "bake/load.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "io/file_context.h"
#include "io/height_file.h"
#include "io/image_io.h"
#include "io/provenance.h"
#include "surface/normals.h"

namespace hemibake {
namespace {

void refuse_holes(const std::filesystem::path& path, const HeightFile& file) {
  const auto first = std::ranges::find(file.holes.values, 1);
  if (first == file.holes.values.end()) return;
  const auto texel = first - file.holes.values.begin();
  throw InputError(
      fmt::format("{}: {} texels have no height (first at {},{}), expected heights everywhere, or "
                  "--holes fill",
                  path.string(), std::ranges::count(file.holes.values, 1), texel % file.holes.width,
                  texel / file.holes.width));
}

Surface read_surface(const MapSettings& settings, double& lowest_m, std::optional<GeoPlace>& place) {
  HeightFile file = read_height_file(settings.map, settings.file);
  refuse_holes(settings.map, file);
  place = file.place;
  Grid<float> heights = std::move(file.values);
  return with_file_context(settings.map, [&] {
    if (settings.filter.radius > 0) heights = bilateral_filter(heights, settings.filter, settings.edge);
    lowest_m = settings.amplitude_m * static_cast<double>(*std::ranges::min_element(heights.values));
    return make_surface(std::move(heights), settings.size_m, settings.amplitude_m, settings.edge);
  });
}

void read_normals(const MapSettings& settings, NormalLength lengths, LoadedMap& map) {
  const Grid<glm::vec3> encoded =
      read_normal_map(settings.normal_map, map.surface.width(), map.surface.height()).values;
  map.surface.normals =
      with_file_context(settings.normal_map, [&] { return decode_normal_map(encoded, *settings.normal_y); });
  if (lengths == NormalLength::kStored) map.normal_lengths = normal_map_lengths(encoded);
}

}  // namespace

MapHashes hash_files(const MapSettings& settings) {
  MapHashes hashes{sha256_of_file(settings.map), ""};
  if (settings.normals_from == NormalSource::kMap) hashes.normal_map = sha256_of_file(settings.normal_map);
  return hashes;
}

LoadedMap load_map(const MapSettings& settings, NormalLength lengths) {
  LoadedMap map;
  map.amplitude_m = settings.amplitude_m;
  map.surface = read_surface(settings, map.lowest_m, map.place);
  if (settings.normals_from == NormalSource::kFaces)
    map.surface.normals = angle_weighted_normals(map.surface);
  if (settings.normals_from == NormalSource::kMap) read_normals(settings, lengths, map);
  map.sha256 = hash_files(settings);
  return map;
}

}  // namespace hemibake
