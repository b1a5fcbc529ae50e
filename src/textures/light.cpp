#include "textures/light.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "transport/series.h"

namespace hemibake {

double bounce_albedo_of(const Bake& bake) {
  return bake.bounce.empty() ? kUsualBounceAlbedo : bake.bounce_albedo;
}

double visibility_at(const Bake& bake, size_t texel) {
  const double visibility = bake.visibility.empty() ? static_cast<double>(bake.irradiance.at(0)[texel]) / kPi
                                                    : static_cast<double>(bake.visibility[texel]);
  return std::clamp(visibility, 0.0, 1.0);
}

double irradiance_at(const Bake& bake, size_t texel, double albedo) {
  const double visibility = visibility_at(bake, texel);
  if (albedo == 0) return visibility;
  const size_t count = bake.irradiance.size();
  const double sum = sum_bounces(bake.irradiance, texel, albedo);
  const double last_power = std::pow(albedo, count - 1);
  const double under_way = albedo * last_power * (kPi - sum_bounces(bake.irradiance, texel, 1));
  const double tail =
      series_tail(last_power / albedo * static_cast<double>(bake.irradiance[count - 2][texel]),
                  last_power * static_cast<double>(bake.irradiance[count - 1][texel]), albedo, under_way);
  return std::clamp((sum + tail) / kPi, visibility, 1.0);
}

double bounce_at(const Bake& bake, size_t texel) {
  if (bake.bounce.empty()) return irradiance_at(bake, texel, kUsualBounceAlbedo);
  return std::clamp(static_cast<double>(bake.bounce[texel]), visibility_at(bake, texel), 1.0);
}

}  // namespace hemibake
