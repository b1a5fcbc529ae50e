// A wall lit again: its own albedo per channel, another sky, a sun. Irradiance at the texels, RGB.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Reflectance, 0..1: the same everywhere, or a map.
struct Albedo {
  glm::vec3 constant{0};
  Grid<glm::vec3> map;  // one per texel; empty: constant

  glm::vec3 at(size_t texel) const { return map.empty() ? constant : map[texel]; }
};

// What arrives before any bounce.
struct ColoredLight {
  std::vector<glm::dvec3> texel_light;  // irradiance at every texel
  std::vector<glm::dvec3> patch_light;  // and at every patch
};

struct Relit {
  // What arrives after b bounces, b = 0, 1, …: reflected at every bounce with the albedo of where it was.
  std::vector<Grid<glm::vec3>> bounces;
  Grid<glm::vec3> total;  // all of them, and `rest`
  // What the bounces after the last are worth, as a geometric series with the ratio of the last two, at most
  // the largest albedo: mean and largest over texels and channels. None with fewer than two bounces.
  double mean_rest = 0, largest_rest = 0;
};

// Σ ρᵇ E_b of a bake. irradiance: E_0, E_1, … at albedo 1 under a sky of radiance 1, at least one.
Relit relight_constant(const std::vector<Grid<float>>& irradiance, const glm::vec3& albedo);

// The same with the bounces run again over the links, each patch reflecting with its own albedo.
// patch_albedo: one per patch. bounces: made one by one, 0... most: irradiance that no total exceeds, if
// known.
Relit relight_over_links(const LightTransport& seen, const ColoredLight& direct,
                         const std::vector<glm::vec3>& patch_albedo, int bounces,
                         std::optional<double> most = {});

// Albedo of every patch: of the texel itself, or between a facet's corners where the node is.
std::vector<glm::vec3> albedo_of_patches(const Surface& surface, const Albedo& albedo,
                                         const PatchSet& patches);

}  // namespace hemibake
