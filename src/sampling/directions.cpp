#include "sampling/directions.h"

#include <cmath>

#include "core/constants.h"
#include "sampling/low_discrepancy.h"
#include "sampling/warp.h"

namespace hemibake {

std::vector<WeightedDirection> make_directions(DirectionSet set, int count, double cone_degrees) {
  // cos 90° is 6·10⁻¹⁷ in floating point; the whole hemisphere means exactly 0.
  const double cos_max = cone_degrees >= 180 ? 0 : std::cos(cone_degrees * kPi / 360);
  std::vector<WeightedDirection> directions(static_cast<size_t>(count));
  double uniform_sum = 0, cosine_sum = 0;
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 u((i + 0.5) / count, radical_inverse(2, static_cast<uint32_t>(i)));
    WeightedDirection& direction = directions[static_cast<size_t>(i)];
    if (set == DirectionSet::kUniform) {
      const glm::dvec3 local = sample_uniform_hemisphere(u, cos_max);
      direction = {glm::vec3(local), 1, local.z};
    } else {
      const glm::dvec3 local = sample_cosine_hemisphere(u, cos_max);
      direction = {glm::vec3(local), 1 / local.z, 1};
    }
    uniform_sum += direction.uniform_weight;
    cosine_sum += direction.cosine_weight;
  }
  for (WeightedDirection& direction : directions) {
    direction.uniform_weight /= uniform_sum;
    direction.cosine_weight /= cosine_sum;
  }
  return directions;
}

}  // namespace hemibake
