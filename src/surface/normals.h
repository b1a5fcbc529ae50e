// Makes the shading normals of a height map: from the heights, or decoded from a normal map.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>

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

// What a normal map stores of a component n of −1..1: (n + 1)/2, n itself, or (n + 1)/2 by the curve of sRGB.
enum class NormalEncoding { kLinear, kSigned, kSrgb };

struct NormalDecoding {
  NormalEncoding encoding = NormalEncoding::kLinear;
  NormalY y = NormalY::kDown;
  std::array<bool, 3> negated{};  // x, y, z are stored with the other sign
  bool has_z = true;              // false: z = √(1 − x² − y²), at least 10⁻²
};

// Decodes a normal map; normals are renormalised, but signed ones that are of unit length already.
// encoded: channel values as stored, integers as 0..1. Throws InputError naming the texel where a value is
// not finite, the length is below 10⁻³ or the normal does not point up.
Grid<glm::vec3> decode_normal_map(const Grid<glm::vec3>& encoded, const NormalDecoding& decoding);

// Returns the length of each texel's vector, the divisor of decode_normal_map.
Grid<float> normal_map_lengths(const Grid<glm::vec3>& encoded, const NormalDecoding& decoding);

// How the slopes of a normal map follow those of heights.
struct SlopeAgreement {
  // Correlation of the normals' components, −1..1; absent where either map is flat along that axis.
  std::optional<double> x, y;
  std::optional<double>
      slope_ratio;  // rms slope of the map over that of the heights; absent: heights are flat
};

// Compares two normal maps of the same size, unit length, z > 0. Slopes of the ratio are weighted by z² of
// both normals, so that steep texels do not decide.
SlopeAgreement compare_slopes(const Grid<glm::vec3>& of_map, const Grid<glm::vec3>& of_heights);

}  // namespace hemibake
