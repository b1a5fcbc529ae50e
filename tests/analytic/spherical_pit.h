// A pit that is part of a sphere, for tests: unlike `synth bowl` its light has a closed form on the triangles
// too.
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/constants.h"
#include "surface/facets.h"
#include "surface/surface.h"

namespace hemibake {

struct SphericalPit {
  Surface surface;
  std::vector<uint32_t> texels;  // of the pit
  double escape_share;           // C: E_b/π = C (1 − C)^b in the whole pit
};

// Any part of a sphere, whatever the shape of its rim, sends every point of itself the same share of light:
// its area over the sphere's (the form factor between any two elements of a sphere is dA/4πR²). So the pit is
// all facets whose corners lie below the polar angle T, and around them the ground drops by `kDrop` texels,
// so that nothing else ever blocks: C = 1 − area / 4πR². What is left of discretisation is the sagitta of the
// triangles, texel²/8R², with R in texels: below 4·10⁻⁵ at 60 texels.
inline SphericalPit make_spherical_pit(int width, double polar_angle) {
  constexpr double kDrop = 60;
  const double center = width / 2, rim = 0.46 * width, radius = rim / std::sin(polar_angle);
  const auto inside = [&](double x, double y) { return std::hypot(x - center, y - center) <= rim; };
  Grid<float> heights(width, width);
  for (int y = 0; y < width; ++y)
    for (int x = 0; x < width; ++x)
      if (inside(x, y))
        heights(x, y) = static_cast<float>(
            kDrop + radius - std::sqrt(radius * radius - std::pow(x - center, 2) - std::pow(y - center, 2)));

  SphericalPit pit;
  pit.surface = make_surface(heights, width, 1, Edge::kOpen);
  for (int y = 0; y < width; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!inside(x, y)) continue;
      const glm::dvec2 offset(center - x, center - y);
      const double up = std::sqrt(radius * radius - glm::dot(offset, offset));
      const auto texel = static_cast<uint32_t>(heights.index(x, y));
      pit.surface.normals[texel] = glm::vec3(glm::dvec3(offset, up) / radius);
      pit.texels.push_back(texel);
    }
  }
  double solid_angle = 0;  // of the facets from the sphere's centre, Van Oosterom & Strackee 1983
  const glm::dvec3 middle(center, center, kDrop + radius);
  for (uint32_t facet = 0; facet < facet_count(pit.surface); ++facet) {
    const auto corners = facet_positions_texels(pit.surface, facet);
    if (!inside(corners[0].x, corners[0].y) || !inside(corners[1].x, corners[1].y) ||
        !inside(corners[2].x, corners[2].y))
      continue;
    const auto a = glm::normalize(corners[0] - middle), b = glm::normalize(corners[1] - middle),
               c = glm::normalize(corners[2] - middle);
    solid_angle += 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
                                  1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
  }
  pit.escape_share = 1 - solid_angle / (4 * kPi);
  return pit;
}

}  // namespace hemibake
