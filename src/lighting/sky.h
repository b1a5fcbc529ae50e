// Skies: radiance by direction, RGB, and the irradiance of a receiver that nothing shades.
//
// Directions are in the frame of the map: x right, y down the image rows, z up.
//
// Spherical harmonics: nine coefficients of radiance in the order and with the real basis of R. Ramamoorthi
// and P. Hanrahan, "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001, eq. 3:
// L00, L1−1, L10, L11, L2−2, L2−1, L20, L21, L22 with
//   Y00 = 0.282095, (Y1−1, Y10, Y11) = 0.488603 (y, z, x), (Y2−2, Y2−1, Y21) = 1.092548 (xy, yz, xz),
//   Y20 = 0.315392 (3z² − 1), Y22 = 0.546274 (x² − y²).
//
// Latitude-longitude maps: the top row is straight up, the bottom row straight down. Columns run through the
// azimuth from 0 at the left edge to 360° at the right, clockwise as seen in the map's picture: 0 is towards
// its top, 90° towards its right.
#pragma once

#include <array>
#include <glm/vec3.hpp>

#include "core/grid.h"

namespace hemibake {

inline constexpr int kHarmonics = 9;

// Of radiance, see above.
using SkyHarmonics = std::array<glm::dvec3, kHarmonics>;

// The nine basis functions in a direction (unit).
std::array<double, kHarmonics> harmonic_basis(const glm::dvec3& direction);

// Negative where the nine coefficients ring.
glm::dvec3 harmonic_radiance(const SkyHarmonics& sky, const glm::dvec3& direction);

// ∫ L max(0, n·ω) dω over the whole sphere of directions: Σ A_l L_lm Y_lm(n), A = π, 2π/3, π/4 (eq. 12).
glm::dvec3 harmonic_irradiance(const SkyHarmonics& sky, const glm::dvec3& normal);

// Azimuth and elevation as above, radians.
glm::dvec3 direction_of(double azimuth_rad, double elevation_rad);

// Bilinear between the centres of the pixels.
glm::dvec3 lat_long_radiance(const Grid<glm::vec3>& map, const glm::dvec3& direction);

// Coefficients of the map: every pixel's centre, weighed by its exact solid angle.
SkyHarmonics project_to_harmonics(const Grid<glm::vec3>& map);

// The sky of a picture.
struct Sky {
  SkyHarmonics harmonics{};  // what an unshaded receiver is lit by
  Grid<glm::vec3> lat_long;  // what the ground truth is lit by; empty: by the harmonics
  bool uniform = false;      // radiance 1 everywhere

  glm::dvec3 radiance(const glm::dvec3& direction) const {
    return lat_long.empty() ? harmonic_radiance(harmonics, direction)
                            : lat_long_radiance(lat_long, direction);
  }
  // Over all directions.
  glm::dvec3 mean_radiance() const;
};

Sky make_uniform_sky();

// Light from one direction.
struct Sun {
  glm::dvec3 direction{0, 0, 1};  // towards it, unit
  double irradiance = 0;          // of a receiver that faces it; a uniform sky of radiance 1 gives π
};

}  // namespace hemibake
