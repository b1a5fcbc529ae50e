// Skies and suns: radiance by direction, RGB, and the irradiance of an unshaded receiver.
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

// Coefficients of radiance in the order above.
using SkyHarmonics = std::array<glm::dvec3, kHarmonics>;

// Returns the nine basis functions in a direction (unit).
std::array<double, kHarmonics> harmonic_basis(const glm::dvec3& direction);

// Returns the radiance in a direction (unit): negative where the nine coefficients ring.
glm::dvec3 harmonic_radiance(const SkyHarmonics& sky, const glm::dvec3& direction);

// Returns ∫ L max(0, n·ω) dω over the whole sphere: Σ A_l L_lm Y_lm(n), A = π, 2π/3, π/4 (eq. 12).
// normal: unit.
glm::dvec3 harmonic_irradiance(const SkyHarmonics& sky, const glm::dvec3& normal);

// Returns the unit vector at an azimuth and elevation as above.
glm::dvec3 direction_of(double azimuth_rad, double elevation_rad);

// Returns the radiance of a map in a direction (unit), bilinear between the centres of its pixels.
glm::dvec3 lat_long_radiance(const Grid<glm::vec3>& map, const glm::dvec3& direction);

// Projects a map to nine coefficients: every pixel's centre, weighed by its exact solid angle.
SkyHarmonics project_to_harmonics(const Grid<glm::vec3>& map);

// A sky lights unshaded receivers by its coefficients, and the ground truth by its map if it has one.
struct Sky {
  SkyHarmonics harmonics{};
  Grid<glm::vec3> lat_long;  // empty: by the coefficients too
  bool uniform = false;      // radiance 1 everywhere

  glm::dvec3 radiance(const glm::dvec3& direction) const {
    return lat_long.empty() ? harmonic_radiance(harmonics, direction)
                            : lat_long_radiance(lat_long, direction);
  }
  // Returns the mean over all directions.
  glm::dvec3 mean_radiance() const;
};

// Makes a sky of radiance 1 everywhere.
Sky make_uniform_sky();

// Makes a sky of a latitude-longitude map and its projection. Throws InputError for negative radiance.
Sky make_lat_long_sky(Grid<glm::vec3> lat_long);

// Light from one direction.
struct Sun {
  glm::dvec3 direction{0, 0, 1};  // towards it, unit
  double irradiance = 0;          // of a receiver that faces it; a uniform sky of radiance 1 gives π
};

}  // namespace hemibake
