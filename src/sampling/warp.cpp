#include "sampling/warp.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"

namespace hemibake {
namespace {

glm::dvec3 direction_at(double cos_theta, double azimuth) {
  const double sin_theta = std::sqrt(std::max(0.0, 1 - cos_theta * cos_theta));
  return {sin_theta * std::cos(azimuth), sin_theta * std::sin(azimuth), cos_theta};
}

double azimuth_over_2pi(const glm::dvec3& direction) {
  const double turns = std::atan2(direction.y, direction.x) / (2 * kPi);
  return turns < 0 ? turns + 1 : turns;
}

}  // namespace

glm::dvec3 sample_uniform_hemisphere(const glm::dvec2& u, double cos_max) {
  return direction_at(1 - u.x * (1 - cos_max), 2 * kPi * u.y);
}

double uniform_hemisphere_pdf(double cos_max) { return 1 / (2 * kPi * (1 - cos_max)); }

glm::dvec2 invert_uniform_hemisphere(const glm::dvec3& direction, double cos_max) {
  return {(1 - direction.z) / (1 - cos_max), azimuth_over_2pi(direction)};
}

glm::dvec3 sample_cosine_hemisphere(const glm::dvec2& u, double cos_max) {
  const double sin2_theta = u.x * (1 - cos_max * cos_max);
  return direction_at(std::sqrt(std::max(0.0, 1 - sin2_theta)), 2 * kPi * u.y);
}

double cosine_hemisphere_pdf(double cos_theta, double cos_max) {
  return cos_theta / (kPi * (1 - cos_max * cos_max));
}

glm::dvec2 invert_cosine_hemisphere(const glm::dvec3& direction, double cos_max) {
  const double sin2_theta = direction.x * direction.x + direction.y * direction.y;
  return {sin2_theta / (1 - cos_max * cos_max), azimuth_over_2pi(direction)};
}

glm::dvec2 sample_uniform_triangle(const glm::dvec2& u) {
  const double root = std::sqrt(u.x);
  return {1 - root, root * u.y};
}

double uniform_triangle_pdf() { return 2; }

glm::dvec2 invert_uniform_triangle(const glm::dvec2& barycentric) {
  const double root = 1 - barycentric.x;
  return {root * root, root > 0 ? barycentric.y / root : 0};
}

}  // namespace hemibake
