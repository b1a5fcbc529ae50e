// The values of a texture from the planes of a bake.
#pragma once

#include <string>
#include <vector>

#include "core/grid.h"
#include "textures/settings.h"
#include "transport/baked_planes.h"

namespace hemibake {

struct Layer {
  std::string channel;  // "Y", or "R", "G", "B", "A", or of an azimuth
  Grid<float> values;   // 0..1; degrees where the texture says so
};

// Maps of other origin that are packed beside the AO, of the bake's size, 0..1; empty where nothing is
// packed.
struct PackedInputs {
  Grid<float> roughness, metallic;
};

// Reads the roughness and the metallic of the settings. Throws InputError naming the file where it is none,
// has another size or a value outside 0..1.
PackedInputs read_packed_inputs(const TextureSettings& settings, int width, int height);

// Returns the channels of one texture of a bake. settings: resolved; the bake passes check_planes (planes.h).
std::vector<Layer> make_layers(const Bake& bake, const TextureSettings& settings, TextureKind kind,
                               const PackedInputs& packed);

// Returns whether the steps of a texture are chosen together with those of the other half of a bounce map: of
// 8 bits without dither, where both halves are written and the light at other albedos is known.
bool chooses_steps(const Bake& bake, const TextureSettings& settings, TextureKind kind);

// Returns in one line what the texture holds: "cosine-weighted visible fraction V = E0/pi".
std::string describe_texture(const Bake& bake, const TextureSettings& settings, TextureKind kind);

}  // namespace hemibake
