// Light that comes straight from a sky that is not the same everywhere, or from a sun: rays in double
// precision against the surface (height_walk.h), so that every direction is seen or not by itself.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "surface/patches.h"
#include "surface/surface.h"

namespace hemibake {

// RGB, of a direction towards the sky (unit, world frame).
using Radiance = std::function<glm::dvec3(const glm::dvec3& direction)>;

struct SkyLightOptions {
  int rays = 256;  // per texel, cosine-distributed, 1..; per patch see rays_per_node (tracers/ray_options.h)
  uint64_t seed = 0;
  // The rays measure how the light differs from that of a sky of this radiance everywhere, which the tracer
  // knows already: a sky close to it needs few, one that is it needs none.
  glm::dvec3 mean_radiance{0};
};

// ∫ L V max(0, n·ω) dω per texel, about its shading normal. direct_over_pi: E₀/π of every texel.
std::vector<glm::dvec3> sky_light_of_texels(const Surface& surface, std::span<const float> direct_over_pi,
                                            const Radiance& radiance, const SkyLightOptions& options);

// The same per patch on facets (surface/patches.h), about the facet's normal.
std::vector<glm::dvec3> sky_light_of_patches(const Surface& surface, const PatchSet& patches,
                                             std::span<const float> direct_over_pi, const Radiance& radiance,
                                             const SkyLightOptions& options);

// max(0, n·ω) times the share of the receiver from which the surface does not hide the direction (unit).
// Texels: over their square of the ground, so that shadows have smooth edges; patches: over where they look
// from.
std::vector<double> sun_share_of_texels(const Surface& surface, const glm::dvec3& direction);
std::vector<double> sun_share_of_patches(const Surface& surface, const PatchSet& patches,
                                         const glm::dvec3& direction);

}  // namespace hemibake
