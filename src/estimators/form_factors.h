// Form factors of disks and polygons.
//
// [1] Bunnell, "Dynamic Ambient Occlusion and Indirect Lighting", GPU Gems 2, ch. 14, 2005.
// [2] Hoberock, Jia, "High-Quality Ambient Occlusion", GPU Gems 3, ch. 12, 2007.
//
// Positions and areas share any one unit of length. `to_disk`: from the receiver to the disk's centre, not
// zero. Normals are unit.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <span>

#include "core/constants.h"

namespace hemibake {

// The side of a disk that occludes. In [1] shadows are cast from the back, which needs a closed mesh: light
// that enters a solid leaves it again. A height map has no bottom, so the default is the front, which faces
// the receiver.
enum class OccluderSide { kFront, kBack };

// Returns the cosine between the side that occludes and the direction to the receiver, clamped to 0..1.
inline double occluder_cosine(const glm::dvec3& disk_normal, const glm::dvec3& direction_to_disk,
                              OccluderSide side) {
  const double toward_back = glm::dot(disk_normal, direction_to_disk);
  return std::clamp(side == OccluderSide::kBack ? toward_back : -toward_back, 0.0, 1.0);
}

// Factor of the receiver's cosine that [1] found by experiment: clamped to 1 it makes the weight nearly
// uniform.
inline constexpr double kReceiverCosineFactor = 4;

// Returns the share of the hemisphere that a disk covers, about uniformly weighted, 0..1:
// (1 − d/√(A/π + d²)) s(cos θ_E) s(4 cos θ_R), s clamping to 0..1 ([1], SolidAngle() of its shader).
inline double disk_shadow(const glm::dvec3& to_disk, const glm::dvec3& disk_normal, double area_over_pi,
                          const glm::dvec3& receiver_normal, OccluderSide side) {
  const double distance2 = glm::dot(to_disk, to_disk);
  const glm::dvec3 direction = to_disk / std::sqrt(distance2);
  return (1 - 1 / std::sqrt(area_over_pi / distance2 + 1)) * occluder_cosine(disk_normal, direction, side) *
         std::clamp(kReceiverCosineFactor * glm::dot(receiver_normal, direction), 0.0, 1.0);
}

// Returns the form factor of a disk, 0..1: (A/π)/(A/π + d²) s(cos θ_E) s(cos θ_R) ([1] eq. 14-2, [2]).
inline double disk_form_factor(const glm::dvec3& to_disk, const glm::dvec3& disk_normal, double area_over_pi,
                               const glm::dvec3& receiver_normal, OccluderSide side) {
  const double distance2 = glm::dot(to_disk, to_disk);
  const glm::dvec3 direction = to_disk / std::sqrt(distance2);
  return area_over_pi / (area_over_pi + distance2) * occluder_cosine(disk_normal, direction, side) *
         std::clamp(glm::dot(receiver_normal, direction), 0.0, 1.0);
}

struct ClippedTriangle {
  std::array<glm::dvec3, 4> corner;
  int count = 0;  // 0, 3 or 4

  std::span<const glm::dvec3> corners() const { return {corner.data(), static_cast<size_t>(count)}; }
};

// Clips a triangle by the plane through the origin with this normal. Returns the part above, in its order.
ClippedTriangle clip_to_horizon(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal);

// Returns the exact form factor of a polygon above the receiver's plane, −1..1: (1/2π) Σ θ_i (n·n_i), θ_i the
// angle an edge subtends and n_i the normal of its plane with the receiver (Lambert 1760; [2]). Positive if
// the polygon's right-handed normal points towards the receiver. corners: relative to the receiver.
double polygon_form_factor(std::span<const glm::dvec3> corners, const glm::dvec3& receiver_normal);

}  // namespace hemibake
