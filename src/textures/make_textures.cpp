#include "textures/make_textures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>

#include "bake/record.h"
#include "io/geo_place.h"
#include "io/geo_write.h"
#include "io/output_file.h"
#include "textures/bounce_map.h"
#include "textures/layers.h"
#include "textures/light.h"
#include "textures/planes.h"
#include "textures/terrain_layers.h"

namespace hemibake {
namespace {

bool holds_vectors(TextureKind kind) { return kind == TextureKind::kBent || kind == TextureKind::kNormal; }

bool holds_bounce(const TextureSettings& settings, TextureKind kind) {
  const bool packed = kind == TextureKind::kOrm || kind == TextureKind::kMask;
  return kind == TextureKind::kBounce || kind == TextureKind::kBounceMap ||
         (packed && settings.occlusion == TextureKind::kBounce);
}

Provenance record_texture(const Provenance& of_bake, const Bake& bake, const TextureSettings& settings,
                          TextureKind kind) {
  Provenance p = of_bake;
  for (const char* of_the_maker : {"input_path", "bake_input_path", "normals_path"}) p.erase(of_the_maker);
  record_texture_settings(settings, kind, p);
  p["holds"] = describe_texture(bake, settings, kind);
  p["encoding"] = is_terrain(kind)      ? terrain_encoding(settings, kind)
                  : holds_vectors(kind) ? "linear, 0..1 for -1..1"
                                        : "linear, 0..1";
  if (holds_vectors(kind)) p["green"] = *settings.normal_y == NormalY::kUp ? "up" : "down";
  if (holds_bounce(settings, kind)) p["bounce_albedo"] = bounce_albedo_of(bake);
  if (kind == TextureKind::kIrradiance) p["albedo"] = fmt::format("{:g}", fmt::join(settings.albedo, ","));
  return p;
}

// Puts the chosen steps in the place of V and of the light at the bounce albedo.
void store_chosen(const BounceMap& chosen, TextureKind kind, std::vector<Layer>& layers) {
  layers[0].values = kind == TextureKind::kBounce ? chosen.bounce : chosen.visibility;
  if (kind == TextureKind::kBounceMap) layers[1].values = chosen.bounce;
}

std::optional<BounceMap> chosen_bounce_map(const Bake& bake, const TextureSettings& settings) {
  const auto is_chosen = [&](TextureKind kind) { return chooses_steps(bake, settings, kind); };
  if (std::ranges::none_of(settings.kinds, is_chosen)) return std::nullopt;
  const int steps = (1 << texture_format_info(settings.coding.format).bits) - 1;
  return choose_bounce_map(bake.width, bake.height, steps, bake.bounce_albedo,
                           [&](size_t texel) { return mapped_light_at(bake, texel); });
}

// Returns whether a texture is, or is the second half of, a bounce map whose loss is known.
bool completes_bounce_map(const TextureSettings& settings, TextureKind kind) {
  if (settings.coding.dither) return false;
  if (kind == TextureKind::kBounceMap) return true;
  return kind == TextureKind::kBounce && settings.wants(TextureKind::kVisibility) &&
         !settings.wants(TextureKind::kBounceMap);
}

// Takes the values of holes away: NaN where the format has it, else 0 and, in a texture without alpha, alpha
// 0.
void clear_holes(const Grid<uint8_t>& holes, const TextureCoding& coding, std::vector<Layer>& layers) {
  if (holes.empty()) return;
  const bool is_float = texture_format_info(coding.format).is_float;
  const float none = is_float ? std::numeric_limits<float>::quiet_NaN() : 0;
  if (!is_float && layers.size() < 4) layers.push_back({"A", Grid<float>(holes.width, holes.height, 1)});
  for (Layer& layer : layers)
    for (size_t i = 0; i < holes.size(); ++i)
      if (holes[i] != 0) layer.values[i] = none;
}

ChannelRange range_of(const Layer& layer) {
  ChannelRange range{layer.channel, HUGE_VAL, 0, -HUGE_VAL};
  size_t count = 0;
  for (const float value : layer.values.values) {
    if (std::isnan(value)) continue;
    ++count;
    range.low = std::min(range.low, static_cast<double>(value));
    range.high = std::max(range.high, static_cast<double>(value));
    range.mean += static_cast<double>(value);
  }
  range.mean /= static_cast<double>(count);
  return range;
}

void write_one(OutputFile& file, const Bake& bake, const std::vector<Plane>& planes,
               const TextureCoding& coding, const Grid<uint8_t>& holes, const Provenance& provenance) {
  if (coding.format == TextureFormat::kTif)
    if (const std::optional<GeoPlace> place = recorded_place(provenance))
      return write_geo_tiff(file, bake.width, bake.height, planes, {*place, holes}, provenance);
  write_texture(file, bake.width, bake.height, planes, coding, provenance);
}

}  // namespace

void record_texture_settings(const TextureSettings& settings, TextureKind kind, Provenance& provenance) {
  TextureSettings copy = settings;
  provenance["texture"] = texture_name(kind);
  record_fields(texture_fields(copy), provenance);
  if (kind == TextureKind::kHorizon) provenance["horizon_azimuths"] = settings.horizon_azimuths;
}

std::vector<WrittenTexture> make_textures(const TextureSource& source, const Provenance& provenance,
                                          const TextureSettings& settings,
                                          const std::filesystem::path& folder, const std::string& name) {
  const Bake& bake = source.bake;
  const Grid<uint8_t> holes = holes_of(bake);
  check_planes(bake, settings);
  const PackedInputs packed = read_packed_inputs(settings, bake.width, bake.height);
  const std::vector<std::filesystem::path> paths = texture_paths(settings, folder, name);
  const std::optional<BounceMap> chosen = chosen_bounce_map(bake, settings);
  std::vector<std::unique_ptr<OutputFile>> files;
  std::vector<WrittenTexture> written;
  for (size_t t = 0; t < paths.size(); ++t) {
    const TextureKind kind = settings.kinds[t];
    std::vector<Layer> layers = is_terrain(kind) ? terrain_layers(source.terrain, settings, kind)
                                                 : make_layers(bake, settings, kind, packed);
    if (chooses_steps(bake, settings, kind)) store_chosen(*chosen, kind, layers);
    WrittenTexture texture{kind, paths[t], describe_texture(bake, settings, kind), {}, {}};
    clear_holes(holes, settings.coding, layers);
    if (completes_bounce_map(settings, kind)) texture.bounce_map = bounce_map_loss(bake);
    std::vector<Plane> planes;
    for (const Layer& layer : layers) {
      planes.push_back({layer.channel, layer.values.values.data()});
      texture.channels.push_back(range_of(layer));
    }
    files.push_back(std::make_unique<OutputFile>(paths[t]));
    write_one(*files.back(), bake, planes, settings.coding, holes,
              record_texture(provenance, bake, settings, kind));
    files.back()->finish();
    written.push_back(std::move(texture));
  }
  for (const auto& file : files) file->commit();
  return written;
}

}  // namespace hemibake
