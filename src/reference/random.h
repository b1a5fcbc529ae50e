// Draws random numbers and directions for the reference path tracer, and shares them with nothing else.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/constants.h"

namespace hemibake {

// Generates PCG32: O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms for
// Random Number Generation", Harvey Mudd College HMC-CS-2014-0905, 2014 (pcg32_random_r). One generator per
// (seed, receiver, group).
class RefereeRandom {
 public:
  RefereeRandom(uint64_t seed, uint64_t receiver, uint64_t group)
      : state_(mix(mix(mix(seed) + receiver) + group)) {}

  // Returns a uniform number in (0, 1), never an end.
  double uniform() { return (next_bits() + 0.5) * 0x1p-32; }

  // Returns a uniform number in 0 … count − 1, by rejection of the incomplete last round.
  uint32_t below(uint32_t count) {
    const uint32_t incomplete = (0u - count) % count;
    uint32_t bits = next_bits();
    while (bits < incomplete) bits = next_bits();
    return bits % count;
  }

 private:
  // Mixes bits by the finaliser of MurmurHash3 (Appleby 2011) after an odd step, so that 0 does not stay 0.
  static uint64_t mix(uint64_t bits) {
    bits += 0x9e3779b97f4a7c15ull;
    bits = (bits ^ (bits >> 33)) * 0xff51afd7ed558ccdull;
    bits = (bits ^ (bits >> 33)) * 0xc4ceb9fe1a85ec53ull;
    return bits ^ (bits >> 33);
  }

  uint32_t next_bits() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + 1442695040888963407ull;
    const uint32_t shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const uint32_t rotation = static_cast<uint32_t>(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
  }

  uint64_t state_ = 0;
};

// Draws a unit vector with density proportional to its cosine to `normal`: a uniform point of the unit sphere
// moved by the normal (Shirley, "Ray Tracing in One Weekend", 2016, "True Lambertian Reflection"). It needs
// no frame, so none can be wrong.
inline glm::dvec3 random_cosine_direction(const glm::dvec3& normal, RefereeRandom& random) {
  const double z = 1 - 2 * random.uniform();
  const double radius = std::sqrt(1 - z * z), angle = 2 * kPi * random.uniform();
  const glm::dvec3 sum = normal + glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z);
  const double squared = glm::dot(sum, sum);
  // A point opposite the normal to rounding, one in 10¹⁰ or fewer, leaves no direction.
  return squared > 1e-20 ? sum / std::sqrt(squared) : normal;
}

// Returns the unit vector with cosine u to `normal`, at azimuth 2πv about it: uniform in solid angle over its
// hemisphere for uniform u, v in 0..1.
inline glm::dvec3 uniform_direction(const glm::dvec3& normal, double u, double v) {
  const glm::dvec3 aside = std::abs(normal.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 tangent = glm::normalize(glm::cross(normal, aside));
  const double sine = std::sqrt(1 - u * u), angle = 2 * kPi * v;
  return u * normal + sine * (std::cos(angle) * tangent + std::sin(angle) * glm::cross(normal, tangent));
}

}  // namespace hemibake
