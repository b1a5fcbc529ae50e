#include "transport/direct_light.h"

#include "core/constants.h"
#include "core/statistics.h"

namespace hemibake {

Bounces direct_light(const Visibility& seen) {
  const int width = seen.direct_over_pi.width, height = seen.direct_over_pi.height;
  Bounces result;
  Grid<float> irradiance(width, height);
  result.residual = Grid<float>(width, height);
  Moments residuals;
  for (size_t i = 0; i < irradiance.size(); ++i) {
    const double direct = static_cast<double>(seen.direct_over_pi[i]), left = 1 - direct;
    irradiance[i] = static_cast<float>(kPi * direct);
    result.residual[i] = static_cast<float>(left);
    residuals.add(left);
    if (i == 0 || left > result.worst_residual) {
      result.worst_residual = left;
      result.worst_texel = static_cast<uint32_t>(i);
    }
  }
  result.mean_residual = residuals.mean;
  result.total = irradiance;
  result.irradiance.push_back(std::move(irradiance));
  return result;
}

}  // namespace hemibake
