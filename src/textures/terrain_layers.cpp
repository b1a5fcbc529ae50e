#include "textures/terrain_layers.h"

#include <fmt/format.h>

#include <utility>

namespace hemibake {
namespace {

bool has_floats(const TextureSettings& settings) {
  return texture_format_info(settings.coding.format).is_float;
}

// Returns the name of a horizon's channel: three digits of degrees, with a fraction where not all are whole.
std::string horizon_channel(int azimuth, int azimuths) {
  const double degrees = 360.0 * azimuth / azimuths;
  return 360 % azimuths == 0 ? fmt::format("horizon.{:03.0f}", degrees)
                             : fmt::format("horizon.{:06.2f}", degrees);
}

Layer angle_layer(Grid<float> degrees, const TextureSettings& settings) {
  if (!has_floats(settings))
    for (float& value : degrees.values) value /= 180;
  return {"Y", std::move(degrees)};
}

}  // namespace

TerrainOptions terrain_options(const TextureSettings& settings) {
  TerrainOptions options;
  options.svf = settings.wants(TextureKind::kSvf);
  options.openness = settings.wants(TextureKind::kOpenness);
  options.negative_openness = settings.wants(TextureKind::kNegativeOpenness);
  options.azimuths = settings.azimuths;
  if (settings.wants(TextureKind::kHorizon)) options.horizon_azimuths = settings.horizon_azimuths;
  if (settings.radius_m) options.radius_m = *settings.radius_m;
  options.curvature = settings.curvature;
  return options;
}

std::vector<Layer> terrain_layers(TerrainPlanes planes, const TextureSettings& settings, TextureKind kind) {
  if (kind == TextureKind::kSvf) return {{"Y", std::move(planes.svf)}};
  if (kind == TextureKind::kOpenness) return {angle_layer(std::move(planes.openness), settings)};
  if (kind == TextureKind::kNegativeOpenness)
    return {angle_layer(std::move(planes.negative_openness), settings)};
  std::vector<Layer> layers;
  const int count = static_cast<int>(planes.horizons.size());
  for (int k = 0; k < count; ++k)
    layers.push_back({horizon_channel(k, count), std::move(planes.horizons[static_cast<size_t>(k)])});
  return layers;
}

std::string describe_terrain_texture(const TextureSettings& settings, TextureKind kind) {
  if (kind == TextureKind::kSvf)
    return "sky-view factor of horizontal ground: mean over azimuths of 1 - sin of the horizon's elevation, "
           "at least 0";
  if (kind == TextureKind::kHorizon)
    return fmt::format("elevation of the horizon over the horizontal, {} azimuths clockwise from up (north)",
                       settings.horizon_azimuths);
  return fmt::format("{} openness: mean over azimuths of the angle from the {} to the horizon",
                     kind == TextureKind::kOpenness ? "positive" : "negative",
                     kind == TextureKind::kOpenness ? "zenith" : "nadir");
}

std::string terrain_encoding(const TextureSettings& settings, TextureKind kind) {
  if (kind == TextureKind::kSvf) return "linear, 0..1";
  return has_floats(settings) ? "linear, degrees" : "linear, 0..1 for 0..180 degrees";
}

}  // namespace hemibake
