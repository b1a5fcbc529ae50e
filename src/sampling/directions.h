// Sets of directions over the hemisphere with weights that make flat open ground exactly α = 1 and E₀ = π.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace hemibake {

// How directions are spread: equal solid angles, or equal shares of irradiance.
enum class DirectionSet { kUniform, kCosine };

struct WeightedDirection {
  glm::vec3 local;        // unit, tangent frame (z = normal)
  double uniform_weight;  // share of the visible fraction α; all sum to 1
  double cosine_weight;   // share of E₀/π; all sum to 1
};

// Hammersley points ((i+½)/count, radical inverse) warped into the cone about the normal with full aperture
// `cone_degrees` (0..180], count ≥ 1. A set is turned about the normal by each receiver's own angle.
std::vector<WeightedDirection> make_directions(DirectionSet set, int count, double cone_degrees);

}  // namespace hemibake
