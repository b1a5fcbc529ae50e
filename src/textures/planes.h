// The planes of a bake that textures are made of.
#pragma once

#include "bake/settings.h"
#include "textures/settings.h"
#include "transport/baked_planes.h"

namespace hemibake {

// Sets the outputs of a bake to what the textures need: form factors only for light with bounces. textures:
// resolved. bake: not yet resolved.
void bake_only_what_textures_need(const TextureSettings& textures, BakeSettings& bake);

// Throws InputError where the bake lacks a plane that one of the textures needs, a plane has another size
// than the bake, or V and α are not of one bake: α² ≤ V ≤ α(2−α) holds of every surface.
void check_planes(const Bake& bake, const TextureSettings& textures);

}  // namespace hemibake
