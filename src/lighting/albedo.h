// Albedo of a surface: reflectance per channel.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "core/grid.h"
#include "surface/patches.h"
#include "surface/surface.h"

namespace hemibake {

// Reflectance, 0..1: the same everywhere, or a map.
struct Albedo {
  glm::vec3 constant{0};
  Grid<glm::vec3> map;  // one per texel; empty: constant

  glm::vec3 at(size_t texel) const { return map.empty() ? constant : map[texel]; }
};

enum class AlbedoEncoding { kLinear, kSrgb };

// Makes an albedo of an image. Throws InputError for values outside 0..1.
// reflectance: one per texel, 0..1, in the encoding given.
Albedo make_albedo_map(Grid<glm::vec3> reflectance, AlbedoEncoding encoding);

// Returns the albedo of every patch: the texel's own, or that between a facet's corners at the node.
std::vector<glm::vec3> albedo_of_patches(const Surface& surface, const Albedo& albedo,
                                         const PatchSet& patches);

}  // namespace hemibake
