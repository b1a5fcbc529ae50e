// Sends light round a surface again, at an albedo per channel. Irradiance at the texels, RGB.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "core/grid.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Irradiance before any bounce.
struct ColoredLight {
  std::vector<glm::dvec3> texel_light;  // one per texel
  std::vector<glm::dvec3> patch_light;  // one per patch
};

struct Relit {
  // Irradiance after b bounces, b = 0, 1, …: reflected at every bounce with the albedo of where it was.
  std::vector<Grid<glm::vec3>> bounces;
  Grid<glm::vec3> total;  // all of them and the tail of the series (transport/series.h)
  // The tail over texels and channels; 0 with fewer than two bounces.
  double mean_rest = 0, largest_rest = 0;
};

// Returns the light of a bake at one albedo: Σ ρᵇ E_b.
// irradiance: E_0, E_1, … at albedo 1 under a sky of radiance 1, at least one plane. albedo: 0..1.
Relit relight_constant(const std::vector<Grid<float>>& irradiance, const glm::vec3& albedo);

// Runs the bounces again over the form factors, each patch reflecting with its own albedo.
// direct: in any unit. patch_albedo: one per patch, 0..1.
// bounces: made one by one, 0...
// most: irradiance that no total exceeds, in the unit of the direct light.
Relit relight_by_transport(const LightTransport& transport, const ColoredLight& direct,
                           const std::vector<glm::vec3>& patch_albedo, int bounces,
                           double most = std::numeric_limits<double>::infinity());

}  // namespace hemibake
