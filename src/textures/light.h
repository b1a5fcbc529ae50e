// Light of one texel as textures hold it, from whatever planes a bake has. Everything is over π and in 0..1.
#pragma once

#include "transport/baked_planes.h"

namespace hemibake {

// Albedo of the bounce textures of bakes without the plane `bounce`.
inline constexpr double kUsualBounceAlbedo = 0.9;

// Returns the albedo of the bounce textures of a bake.
double bounce_albedo_of(const Bake& bake);

// Returns V: the plane `visibility`, or E₀/π.
double visibility_at(const Bake& bake, size_t texel);

// Returns the light of all bounces at an albedo, at least V: the stored bounces and a geometric tail, at most
// the energy under way. The tail leads to the plane `bounce` at its albedo, or continues the last two
// bounces. albedo: 0..1; above 0 the bake has a bounce.
double irradiance_at(const Bake& bake, size_t texel, double albedo);

// Returns irradiance_at without regard to the plane `bounce`. albedo: above 0.
double irradiance_by_bounces(const Bake& bake, size_t texel, double albedo);

// Returns the light of all bounces at bounce_albedo_of(bake): the plane `bounce`, or irradiance_at.
double bounce_at(const Bake& bake, size_t texel);

}  // namespace hemibake
