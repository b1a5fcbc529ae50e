#include "lighting/sky.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"

namespace hemibake {
namespace {

// Normalisations of the basis: √(1/4π), √(3/4π), √(15/4π), √(5/16π), √(15/16π).
const double kY0 = std::sqrt(1 / (4 * kPi));
const double kY1 = std::sqrt(3 / (4 * kPi));
const double kY2 = std::sqrt(15 / (4 * kPi));
const double kY20 = std::sqrt(5 / (16 * kPi));
const double kY22 = std::sqrt(15 / (16 * kPi));

// Coefficients of the clamped cosine lobe in each band.
constexpr std::array<double, kHarmonics> kCosineLobe = {
    kPi, 2 * kPi / 3, 2 * kPi / 3, 2 * kPi / 3, kPi / 4, kPi / 4, kPi / 4, kPi / 4, kPi / 4};

}  // namespace

std::array<double, kHarmonics> harmonic_basis(const glm::dvec3& d) {
  return {kY0,
          kY1 * d.y,
          kY1 * d.z,
          kY1 * d.x,
          kY2 * d.x * d.y,
          kY2 * d.y * d.z,
          kY20 * (3 * d.z * d.z - 1),
          kY2 * d.x * d.z,
          kY22 * (d.x * d.x - d.y * d.y)};
}

glm::dvec3 harmonic_radiance(const SkyHarmonics& sky, const glm::dvec3& direction) {
  const auto basis = harmonic_basis(direction);
  glm::dvec3 sum(0);
  for (int i = 0; i < kHarmonics; ++i) sum += basis[i] * sky[i];
  return sum;
}

glm::dvec3 harmonic_irradiance(const SkyHarmonics& sky, const glm::dvec3& normal) {
  const auto basis = harmonic_basis(normal);
  glm::dvec3 sum(0);
  for (int i = 0; i < kHarmonics; ++i) sum += kCosineLobe[i] * basis[i] * sky[i];
  return sum;
}

glm::dvec3 direction_of(double azimuth_rad, double elevation_rad) {
  const double level = std::cos(elevation_rad);
  return {level * std::sin(azimuth_rad), -level * std::cos(azimuth_rad), std::sin(elevation_rad)};
}

glm::dvec3 lat_long_radiance(const Grid<glm::vec3>& map, const glm::dvec3& d) {
  const double azimuth_share = std::atan2(d.x, -d.y) / (2 * kPi);
  const double column = azimuth_share * map.width - 0.5;
  const double row = std::acos(std::clamp(d.z, -1.0, 1.0)) / kPi * map.height - 0.5;
  const double left = std::floor(column), upper = std::floor(row);
  const auto at = [&](int x, int y) {
    return glm::dvec3(map(wrap_index(x, map.width), std::clamp(y, 0, map.height - 1)));
  };
  const int x = static_cast<int>(left), y = static_cast<int>(upper);
  const double u = column - left, v = row - upper;
  return (1 - v) * ((1 - u) * at(x, y) + u * at(x + 1, y)) +
         v * ((1 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

SkyHarmonics project_to_harmonics(const Grid<glm::vec3>& map) {
  SkyHarmonics sky{};
  for (int y = 0; y < map.height; ++y) {
    const double top = kPi * y / map.height, bottom = kPi * (y + 1) / map.height;
    const double solid_angle = 2 * kPi / map.width * (std::cos(top) - std::cos(bottom));
    for (int x = 0; x < map.width; ++x) {
      const double azimuth = 2 * kPi * (x + 0.5) / map.width;
      const auto basis = harmonic_basis(direction_of(azimuth, kPi / 2 - (top + bottom) / 2));
      for (int i = 0; i < kHarmonics; ++i) sky[i] += solid_angle * basis[i] * glm::dvec3(map(x, y));
    }
  }
  return sky;
}

glm::dvec3 Sky::mean_radiance() const { return kY0 * harmonics[0]; }

Sky make_uniform_sky() {
  Sky sky;
  sky.uniform = true;
  sky.harmonics[0] = glm::dvec3(1 / kY0);
  return sky;
}

Sky make_lat_long_sky(Grid<glm::vec3> lat_long) {
  const auto width = static_cast<size_t>(lat_long.width);
  for (size_t i = 0; i < lat_long.size(); ++i)
    if (std::min({lat_long[i].x, lat_long[i].y, lat_long[i].z}) < 0)
      throw InputError(
          fmt::format("negative radiance at pixel {},{}, expected 0 or more", i % width, i / width));
  Sky sky;
  sky.harmonics = project_to_harmonics(lat_long);
  sky.lat_long = std::move(lat_long);
  return sky;
}

}  // namespace hemibake
