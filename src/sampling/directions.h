// Makes sets of directions over the hemisphere, weighted so that flat open ground has exactly α = 1 and E₀ =
// π.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

namespace hemibake {

// Spread of directions: equal solid angles, or equal shares of irradiance.
enum class DirectionSet { kUniform, kCosine };

struct WeightedDirection {
  glm::vec3 local;        // unit, tangent frame (z = normal)
  double uniform_weight;  // share of the visible fraction α; all sum to 1
  double cosine_weight;   // share of E₀/π; all sum to 1
};

// Returns Hammersley points ((i+½)/count, radical inverse) warped into a cone about the normal.
// count: ≥ 1. cone_degrees: full aperture, (0..180]. Each receiver rotates the set by an angle of its own.
std::vector<WeightedDirection> make_directions(DirectionSet set, int count, double cone_degrees);

}  // namespace hemibake
