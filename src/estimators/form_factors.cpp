#include "estimators/form_factors.h"

namespace hemibake {

ClippedTriangle clip_to_horizon(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal) {
  ClippedTriangle clipped;
  std::array<double, 3> height;
  for (size_t i = 0; i < 3; ++i) height[i] = glm::dot(normal, triangle[i]);
  // Sutherland & Hodgman 1974, one plane: a corner above stays, an edge that crosses adds its crossing.
  for (size_t i = 0; i < 3; ++i) {
    const size_t next = (i + 1) % 3;
    if (height[i] > 0) clipped.corner[clipped.count++] = triangle[i];
    if ((height[i] > 0) != (height[next] > 0)) {
      const double along = height[i] / (height[i] - height[next]);
      clipped.corner[clipped.count++] = triangle[i] + along * (triangle[next] - triangle[i]);
    }
  }
  return clipped;
}

double polygon_form_factor(std::span<const glm::dvec3> corners, const glm::dvec3& receiver_normal) {
  double sum = 0;
  for (size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3& a = corners[i];
    const glm::dvec3& b = corners[(i + 1) % corners.size()];
    const glm::dvec3 normal = glm::cross(a, b);
    const double sine = glm::length(normal);
    // An edge in line with the receiver has no plane: it subtends nothing, or passes through the receiver
    // itself.
    if (sine > 0) sum += std::atan2(sine, glm::dot(a, b)) / sine * glm::dot(receiver_normal, normal);
  }
  // An edge counter-clockwise about the normal turns the polygon's own normal away from the receiver.
  return -sum / (2 * kPi);
}

}  // namespace hemibake
