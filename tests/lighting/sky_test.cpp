#include "lighting/sky.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "core/constants.h"

namespace hemibake {
namespace {

// Centres of the pixels of a latitude-longitude map, with their solid angle.
void for_directions(int height,
                    const std::function<void(const glm::dvec3& direction, double solid_angle)>& use) {
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const double top = kPi * y / height, bottom = kPi * (y + 1) / height;
      use(direction_of(kPi * (x + 0.5) / height, kPi / 2 - (top + bottom) / 2),
          kPi / height * (std::cos(top) - std::cos(bottom)));
    }
}

Grid<glm::vec3> map_of(int height, const std::function<glm::dvec3(const glm::dvec3&)>& radiance) {
  Grid<glm::vec3> map(2 * height, height);
  size_t pixel = 0;
  for_directions(height, [&](const glm::dvec3& d, double) { map[pixel++] = glm::vec3(radiance(d)); });
  return map;
}

SkyHarmonics some_harmonics() {
  SkyHarmonics sky;
  for (int i = 0; i < kHarmonics; ++i) sky[i] = {2.0 / (i + 1), 0.3 * i - 1, i % 3 - 0.5};
  return sky;
}

TEST(Sky, BasisIsOrthonormal) {
  double products[kHarmonics][kHarmonics] = {};
  for_directions(200, [&](const glm::dvec3& d, double solid_angle) {
    const auto basis = harmonic_basis(d);
    for (int a = 0; a < kHarmonics; ++a)
      for (int b = 0; b < kHarmonics; ++b) products[a][b] += solid_angle * basis[a] * basis[b];
  });
  // The midpoint rule's error: of the order of a pixel's squared height, (π/200)²/24 ≈ 10⁻⁵, times the second
  // derivative of a product of two of second degree, below 20.
  for (int a = 0; a < kHarmonics; ++a)
    for (int b = 0; b < kHarmonics; ++b) EXPECT_NEAR(products[a][b], a == b, 2e-4) << a << ' ' << b;
}

// Against their printed values.
TEST(Sky, BasisIsThatOfRamamoorthiAndHanrahan) {
  const glm::dvec3 d = glm::normalize(glm::dvec3(0.3, -0.5, 0.7));
  const double expected[] = {0.282095,
                             0.488603 * d.y,
                             0.488603 * d.z,
                             0.488603 * d.x,
                             1.092548 * d.x * d.y,
                             1.092548 * d.y * d.z,
                             0.315392 * (3 * d.z * d.z - 1),
                             1.092548 * d.x * d.z,
                             0.546274 * (d.x * d.x - d.y * d.y)};
  const auto basis = harmonic_basis(d);
  for (int i = 0; i < kHarmonics; ++i)
    EXPECT_NEAR(basis[i], expected[i], 5e-7) << i;  // they print six digits
}

TEST(Sky, UniformSkyGivesPi) {
  const Sky sky = make_uniform_sky();
  for (const glm::dvec3& d : {glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(1, 2, -0.5))}) {
    EXPECT_NEAR(sky.radiance(d).y, 1, 1e-15);
    EXPECT_NEAR(harmonic_irradiance(sky.harmonics, d).x, kPi, 1e-14);
  }
  EXPECT_NEAR(sky.mean_radiance().z, 1, 1e-15);
}

// A sky of nine coefficients is exact in nine coefficients: its irradiance is the integral itself.
TEST(Sky, IrradianceIsTheIntegral) {
  const SkyHarmonics sky = some_harmonics();
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.4, -0.2, 0.6));
  glm::dvec3 integral(0);
  for_directions(400, [&](const glm::dvec3& d, double solid_angle) {
    integral += solid_angle * std::max(0.0, glm::dot(normal, d)) * harmonic_radiance(sky, d);
  });
  // As above with 400 rows, and the kink of the cosine at the rim: another squared pixel.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(harmonic_irradiance(sky, normal)[c], integral[c], 5e-4);
}

TEST(Sky, ProjectionGivesTheCoefficientsBack) {
  const SkyHarmonics sky = some_harmonics();
  const SkyHarmonics back =
      project_to_harmonics(map_of(200, [&](const glm::dvec3& d) { return harmonic_radiance(sky, d); }));
  for (int i = 0; i < kHarmonics; ++i)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[i][c], sky[i][c], 1e-3) << i;
}

TEST(Sky, MapsAreReadWhereTheyWereWritten) {
  const Grid<glm::vec3> map = map_of(16, [](const glm::dvec3& d) { return d; });
  // Between pixel centres a chord of the sphere is read: short of it by at most 1 − cos(half a pixel).
  const double chord = 2 * (1 - std::cos(kPi / 32));
  for_directions(23, [&](const glm::dvec3& d, double) {
    // Above the first row's centres there is nothing to interpolate with.
    if (std::abs(std::asin(d.z)) > kPi / 2 - kPi / 32) return;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(lat_long_radiance(map, d)[c], d[c], chord);
  });
  // Azimuth 90°, clockwise from the top of the map, is to the right; 0 is against the rows.
  EXPECT_NEAR(direction_of(kPi / 2, 0).x, 1, 1e-15);
  EXPECT_NEAR(direction_of(0, 0).y, -1, 1e-15);
  EXPECT_NEAR(direction_of(1, kPi / 2).z, 1, 1e-15);
  // The seam between the last column and the first.
  const glm::dvec3 seam = lat_long_radiance(map, direction_of(0, 0));
  EXPECT_NEAR(seam.x, 0, 1e-6);
  EXPECT_NEAR(seam.y, -1, chord);
}

}  // namespace
}  // namespace hemibake
