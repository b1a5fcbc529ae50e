// Writes the textures of one bake.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "io/provenance.h"
#include "terrain/terrain.h"
#include "textures/bounce_map_loss.h"
#include "textures/settings.h"
#include "transport/baked_planes.h"

namespace hemibake {

struct ChannelRange {
  std::string channel;                 // "Y", or "R", "G", "B", "A"
  double low = 0, mean = 0, high = 0;  // as stored, 0..1
};

struct WrittenTexture {
  TextureKind kind;
  std::filesystem::path path;
  std::string holds;  // in one line
  std::vector<ChannelRange> channels;
  std::optional<BounceMapLoss> bounce_map;  // of the texture that makes one whole; not of dithered ones
};

// The planes that textures are made of, of one size.
struct TextureSource {
  const Bake& bake;
  const TerrainPlanes& terrain;  // of terrain_options (terrain_layers.h)
};

// Records everything of the settings that decides the bytes of one texture. settings: resolved.
void record_texture_settings(const TextureSettings& settings, TextureKind kind, Provenance& provenance);

// Writes every texture of the settings, all or none. source: a bake with the planes of
// bake_only_what_textures_need (planes.h), or more. provenance: how the bake was made. settings: resolved.
// name: what the files' names begin with. A TIFF of a bake that records a place on the earth is a GeoTIFF
// there. Holes of the bake are NoData in a GeoTIFF, NaN in other floats, and 0 with alpha 0 in a PNG that has
// room for it. Throws InputError as check_planes and read_packed_inputs, and where a file cannot be written.
std::vector<WrittenTexture> make_textures(const TextureSource& source, const Provenance& provenance,
                                          const TextureSettings& settings,
                                          const std::filesystem::path& folder, const std::string& name);

}  // namespace hemibake
