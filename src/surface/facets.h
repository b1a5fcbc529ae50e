// The triangles of the surface. Every cell between four neighbouring texel centres is cut by the diagonal
// from (i+1, j) to (i, j+1): facet 2c holds the corner (i, j), facet 2c+1 the corner (i+1, j+1), where c
// numbers the cells row by row. A wrapping map has a cell per texel, an open one a cell less in each
// direction.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "surface/surface.h"

namespace hemibake {

inline constexpr uint32_t kNoFacet = 0xffffffff;

// Corners of a facet in texels, not wrapped: x, y may equal the width or height on a wrapping map.
struct FacetCorners {
  std::array<glm::ivec2, 3> texel;  // [0] is the right-angled corner
};

// Returns the number of facets.
uint32_t facet_count(const Surface& surface);
// Returns the number of cells in a row.
uint32_t facet_columns(const Surface& surface);

// Returns the corners of a facet.
FacetCorners facet_corners(const Surface& surface, uint32_t facet);

// Returns whether a facet is no surface: one of its corners is a hole.
bool facet_is_open(const Surface& surface, uint32_t facet);

// Returns the corner positions in units of texels: x = i, y = j, z = height / texel size (unwrapped).
std::array<glm::dvec3, 3> facet_positions_texels(const Surface& surface, uint32_t facet);

// Returns the position of a facet's point in texels, not wrapped. uv: barycentric, of corners 1 and 2.
glm::dvec2 facet_point_texels(const Surface& surface, uint32_t facet, glm::dvec2 uv);

// Returns the barycentric coordinates of a position on any copy of the map; outside 0..1 off the facet.
glm::dvec2 facet_coordinates(const Surface& surface, uint32_t facet, glm::dvec2 position_texels);

// Returns the unit normal of a facet, z > 0.
glm::dvec3 facet_normal(const Surface& surface, uint32_t facet);

// Returns the area of a facet over the area of its shadow on the ground: 1 / normal.z ≥ 1.
double facet_area_ratio(const Surface& surface, uint32_t facet);

}  // namespace hemibake
