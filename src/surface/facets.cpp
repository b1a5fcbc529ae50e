#include "surface/facets.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace hemibake {

uint32_t facet_columns(const Surface& surface) {
  return static_cast<uint32_t>(surface.edge == Edge::kWrap ? surface.width() : surface.width() - 1);
}

uint32_t facet_count(const Surface& surface) {
  const int rows = surface.edge == Edge::kWrap ? surface.height() : surface.height() - 1;
  return 2 * facet_columns(surface) * static_cast<uint32_t>(rows);
}

FacetCorners facet_corners(const Surface& surface, uint32_t facet) {
  const uint32_t cell = facet / 2;
  const int i = static_cast<int>(cell % facet_columns(surface));
  const int j = static_cast<int>(cell / facet_columns(surface));
  if (facet % 2 == 0) return {{{{i, j}, {i + 1, j}, {i, j + 1}}}};
  return {{{{i + 1, j + 1}, {i, j + 1}, {i + 1, j}}}};
}

bool facet_is_open(const Surface& surface, uint32_t facet) {
  if (surface.holes.empty()) return false;
  return std::ranges::any_of(facet_corners(surface, facet).texel, [&](const glm::ivec2& corner) {
    return surface.is_hole(wrap_index(corner.x, surface.width()), wrap_index(corner.y, surface.height()));
  });
}

std::array<glm::dvec3, 3> facet_positions_texels(const Surface& surface, uint32_t facet) {
  const FacetCorners corners = facet_corners(surface, facet);
  std::array<glm::dvec3, 3> positions;
  for (int c = 0; c < 3; ++c) {
    const glm::ivec2 texel = corners.texel[c];
    const double h = surface.heights_m(texel.x % surface.width(), texel.y % surface.height());
    positions[c] = {texel.x, texel.y, h / surface.texel_size_m};
  }
  return positions;
}

glm::dvec2 facet_point_texels(const Surface& surface, uint32_t facet, glm::dvec2 uv) {
  // Corner 1 lies along x from corner 0, corner 2 along y.
  const double sign = facet % 2 == 0 ? 1 : -1;
  return glm::dvec2(facet_corners(surface, facet).texel[0]) + sign * uv;
}

glm::dvec2 facet_coordinates(const Surface& surface, uint32_t facet, glm::dvec2 position_texels) {
  const FacetCorners corners = facet_corners(surface, facet);
  const double sign = facet % 2 == 0 ? 1 : -1;
  glm::dvec2 offset = position_texels - glm::dvec2(corners.texel[0]);
  // From the copy of the map whose cell has its middle nearest.
  const glm::dvec2 size(surface.width(), surface.height());
  if (surface.edge == Edge::kWrap) offset -= size * glm::round((offset - 0.5 * sign) / size);
  return sign * offset;
}

glm::dvec3 facet_normal(const Surface& surface, uint32_t facet) {
  const auto p = facet_positions_texels(surface, facet);
  // The right-angled corner's legs run along x and y, so the plane's slopes are height differences along
  // them.
  const double sign = facet % 2 == 0 ? 1 : -1;
  const double slope_x = sign * (p[1].z - p[0].z);
  const double slope_y = sign * (p[2].z - p[0].z);
  return glm::normalize(glm::dvec3(-slope_x, -slope_y, 1));
}

double facet_area_ratio(const Surface& surface, uint32_t facet) {
  return 1.0 / facet_normal(surface, facet).z;
}

}  // namespace hemibake
