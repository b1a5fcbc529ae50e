// Lights a scene by a sky and a sun, with all bounces.
#pragma once

#include <glm/vec3.hpp>
#include <optional>

#include "core/grid.h"
#include "lighting/albedo.h"
#include "lighting/relight.h"
#include "lighting/shaded_scene.h"
#include "lighting/sky.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Light that falls on a scene.
struct SceneLight {
  Sky sky;
  std::optional<Sun> sun;
  int sky_rays = 256;  // per texel, about as many per facet, to a sky that is not uniform; 1..
};

// Returns whether light has to go round again: a bake holds the bounces of a uniform sky at one albedo.
bool needs_transport(const SceneLight& light, const Albedo& albedo);

// Returns the irradiance of unshaded texels.
// normals: one per texel; may be empty under a uniform sky only. width, height: texels.
Grid<glm::vec3> unshaded_sky(const Sky& sky, const Grid<glm::vec3>& normals, int width, int height);

// Returns the patches that a transport was traced with.
PatchSet patches_of_transport(const Surface& surface, const LightTransport& transport);

struct LitScene {
  Relit relit;          // sky and sun
  Grid<glm::vec3> sun;  // its irradiance with its shadows; empty: no sun
  // E₀ under the nine coefficients of a sky against E₀ under the sky itself; none for a sky of coefficients.
  std::optional<PictureError> projection_error;
};

// Sends sky and sun round over the form factors.
// transport: of the surface, with form factors to patches_of_transport. bounces: made one by one, 0...
LitScene light_scene(const Surface& surface, const LightTransport& transport, const Albedo& albedo,
                     const SceneLight& light, int bounces);

}  // namespace hemibake
