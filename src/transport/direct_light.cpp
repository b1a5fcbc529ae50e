#include "transport/direct_light.h"

#include "core/constants.h"

namespace hemibake {

Bounces direct_light(const LightTransport& transport) {
  const int width = transport.direct_over_pi.width, height = transport.direct_over_pi.height;
  Bounces result;
  const auto direct = [&](size_t i) { return static_cast<double>(transport.direct_over_pi[i]); };
  compute_residual(direct, width, height, result);
  Grid<float> irradiance(width, height);
  for (size_t i = 0; i < irradiance.size(); ++i) irradiance[i] = static_cast<float>(kPi * direct(i));
  result.total = irradiance;
  result.irradiance.push_back(std::move(irradiance));
  return result;
}

}  // namespace hemibake
