// An orthonormal frame about a unit vector.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

namespace hemibake {

struct Frame {
  glm::dvec3 tangent, bitangent, normal;

  glm::dvec3 world_from_tangent(const glm::dvec3& v) const {
    return v.x * tangent + v.y * bitangent + v.z * normal;
  }
};

// Returns a frame about a unit vector: Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1),
// 2017: Frisvad's frame without its pole.
inline Frame frame_about(const glm::dvec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

// Returns the frame rotated about its normal by `angle` radians.
inline Frame rotated(const Frame& frame, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * frame.tangent + s * frame.bitangent, c * frame.bitangent - s * frame.tangent, frame.normal};
}

}  // namespace hemibake
