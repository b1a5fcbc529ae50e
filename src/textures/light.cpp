#include "textures/light.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "transport/series.h"

namespace hemibake {
namespace {

double last_power(const Bake& bake, double albedo) { return std::pow(albedo, bake.irradiance.size() - 1); }

// Returns the bounce before the last, at albedo 1, with which the tail leads to the plane `bounce`.
double before_last_by_plane(const Bake& bake, size_t texel) {
  const double albedo = bake.bounce_albedo;
  const double last = static_cast<double>(bake.irradiance.back()[texel]);
  const double tail =
      kPi * static_cast<double>(bake.bounce[texel]) - sum_bounces(bake.irradiance, texel, albedo);
  return tail > 0 ? albedo * last * (1 + last_power(bake, albedo) * last / tail) : 0;
}

// before: the bounce before the last at albedo 1; the tail goes on with its ratio to the last. albedo: above
// 0.
double sum_with_tail(const Bake& bake, size_t texel, double albedo, double before) {
  const double power = last_power(bake, albedo);
  const double sum = sum_bounces(bake.irradiance, texel, albedo);
  const double under_way = albedo * power * (kPi - sum_bounces(bake.irradiance, texel, 1));
  const double tail = series_tail(
      power / albedo * before, power * static_cast<double>(bake.irradiance.back()[texel]), albedo, under_way);
  return std::clamp((sum + tail) / kPi, visibility_at(bake, texel), 1.0);
}

}  // namespace

double bounce_albedo_of(const Bake& bake) {
  return bake.bounce.empty() ? kUsualBounceAlbedo : bake.bounce_albedo;
}

double visibility_at(const Bake& bake, size_t texel) {
  const double visibility = bake.visibility.empty() ? static_cast<double>(bake.irradiance.at(0)[texel]) / kPi
                                                    : static_cast<double>(bake.visibility[texel]);
  return std::clamp(visibility, 0.0, 1.0);
}

double irradiance_at(const Bake& bake, size_t texel, double albedo) {
  if (albedo == 0) return visibility_at(bake, texel);
  if (bake.bounce.empty()) return irradiance_by_bounces(bake, texel, albedo);
  return sum_with_tail(bake, texel, albedo, before_last_by_plane(bake, texel));
}

double irradiance_by_bounces(const Bake& bake, size_t texel, double albedo) {
  const Grid<float>& before = bake.irradiance[bake.irradiance.size() - 2];
  return sum_with_tail(bake, texel, albedo, static_cast<double>(before[texel]));
}

double bounce_at(const Bake& bake, size_t texel) {
  if (bake.bounce.empty()) return irradiance_at(bake, texel, kUsualBounceAlbedo);
  return std::clamp(static_cast<double>(bake.bounce[texel]), visibility_at(bake, texel), 1.0);
}

}  // namespace hemibake
