// Makes the shading normals of a height map: from the heights, or decoded from a normal map.
#pragma once

#include <glm/vec3.hpp>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// Direction of the green channel of a normal map: kUp against the image rows (OpenGL), kDown along them
// (DirectX).
enum class NormalY { kUp, kDown };

// Returns normals by central differences of the heights, across the seam of a wrapping map, one-sided at open
// edges.
Grid<glm::vec3> central_difference_normals(const Surface& surface);

// Returns the mean normal of the facets around each texel, weighted by the facet's angle there (Thürmer,
// Wüthrich 1998).
Grid<glm::vec3> angle_weighted_normals(const Surface& surface);

// Decodes a normal map. encoded: channel values 0..1, n = 2·value − 1, renormalised; y as `convention` says.
// Throws InputError naming the texel where a value is not finite, the length is below 10⁻³ or the normal does
// not point up.
Grid<glm::vec3> decode_normal_map(const Grid<glm::vec3>& encoded, NormalY convention);

// Returns |2·value − 1| of each texel, the divisor of decode_normal_map.
Grid<float> normal_map_lengths(const Grid<glm::vec3>& encoded);

}  // namespace hemibake
