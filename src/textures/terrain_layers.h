// Textures of a terrain: the sky-view factor, openness and horizons of its map.
#pragma once

#include <string>
#include <vector>

#include "terrain/terrain.h"
#include "textures/layers.h"
#include "textures/settings.h"

namespace hemibake {

// Returns the planes that the textures need. settings: resolved.
TerrainOptions terrain_options(const TextureSettings& settings);

// Returns the channels of one texture: "Y", or "horizon.000", … by degrees. Angles are degrees in float
// formats, and degrees over 180 in the others. kind: is_terrain.
std::vector<Layer> terrain_layers(TerrainPlanes planes, const TextureSettings& settings, TextureKind kind);

// Returns in one line what a texture of terrain holds.
std::string describe_terrain_texture(const TextureSettings& settings, TextureKind kind);

// Returns how its values are encoded: "linear, degrees".
std::string terrain_encoding(const TextureSettings& settings, TextureKind kind);

}  // namespace hemibake
