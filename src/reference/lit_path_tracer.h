// Measures irradiance by path tracing under any sky and at any albedo, RGB: the ground truth of lighting/. As
// unbiased as path_tracer.h, with the same ray caster, lift and random numbers.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

struct RefereeLighting {
  // Radiance from where `direction` (unit, world frame) points, ≥ 0 per channel. Called from many threads.
  // Open edges ask for directions below the horizon as well.
  std::function<glm::dvec3(const glm::dvec3& direction)> sky;
  // 0..1 per channel: one value per texel, bilinear between texel centres (clamped at open edges), or 1×1.
  Grid<glm::vec3> albedo;
};

struct RefereeIrradiance {
  glm::dvec3 mean{0};      // in the unit of the sky's radiance times sr: π on open ground under a sky of 1
  glm::dvec3 variance{0};  // of that mean
};

// Measures the irradiance of texels. Russian roulette keeps a path with the largest channel of the albedo it
// hits as probability, so its weight never grows.
// texels: row-major indices. paths: per texel, 2... Throws InputError for sizes and values out of range.
std::vector<RefereeIrradiance> referee_lit_texels(const Surface& surface, std::span<const uint32_t> texels,
                                                  const RefereeLighting& lighting, int paths, uint64_t seed);

}  // namespace hemibake
