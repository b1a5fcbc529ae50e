// Traces direct light of a sky that is not uniform, or of a sun, with rays in double precision
// (reference/ray_caster.h): every direction by itself.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "surface/patches.h"
#include "surface/surface.h"

namespace hemibake {

// Returns RGB radiance from a direction towards the sky (unit, world frame).
using Radiance = std::function<glm::dvec3(const glm::dvec3& direction)>;

struct SkyLightOptions {
  int rays = 256;  // per texel, cosine-distributed, 1..; per patch see rays_per_node (tracers/ray_options.h)
  uint64_t seed = 0;
  // Control variate: rays measure the difference from a uniform sky of this radiance, whose light the
  // transport holds.
  glm::dvec3 mean_radiance{0};
};

// Returns ∫ L V max(0, n·ω) dω of every texel about its shading normal, V the visibility of the sky.
// direct_over_pi: E₀/π of every texel.
std::vector<glm::dvec3> sky_light_of_texels(const Surface& surface, std::span<const float> direct_over_pi,
                                            const Radiance& radiance, const SkyLightOptions& options);

// Returns ∫ L V max(0, n·ω) dω of every patch on facets (surface/patches.h) about the facet's normal.
// direct_over_pi: E₀/π of every patch.
std::vector<glm::dvec3> sky_light_of_patches(const Surface& surface, const PatchSet& patches,
                                             std::span<const float> direct_over_pi, const Radiance& radiance,
                                             const SkyLightOptions& options);

// Returns max(0, n·ω) times the unshadowed share of every texel's square of the ground, for smooth edges of
// shadows. direction: ω towards the sun, unit.
std::vector<double> sun_share_of_texels(const Surface& surface, const glm::dvec3& direction);
// Returns max(0, n·ω) times the unshadowed share of the points where every patch receives light.
std::vector<double> sun_share_of_patches(const Surface& surface, const PatchSet& patches,
                                         const glm::dvec3& direction);

}  // namespace hemibake
