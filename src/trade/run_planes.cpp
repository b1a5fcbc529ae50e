#include "trade/run_planes.h"

#include <fmt/format.h>

#include "core/constants.h"
#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {

const std::array<NamedPlane, kPlaneCount>& named_planes() {
  static const std::array<NamedPlane, kPlaneCount> planes = [] {
    std::array<NamedPlane, kPlaneCount> all;
    all[kAoPlane] = {"ao", "uniform visible fraction", &RunPlanes::uniform, 0};
    all[kDirectPlane] = {"direct", "E0/pi, the cosine-weighted visible fraction", &RunPlanes::cosine, 0};
    all[kFirstPlane] = {"first", "E1/pi, one bounce at albedo 1", &RunPlanes::first_bounce, 0};
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a)
      all[kLightPlanes + a] = {fmt::format("light.{:02.0f}", 100 * kJudgedAlbedos[a]),
                               fmt::format("E/pi, all bounces at albedo {:g}", kJudgedAlbedos[a]), nullptr, a};
    return all;
  }();
  return planes;
}

void add_bounces(const std::vector<Grid<float>>& irradiance, RunPlanes& planes) {
  if (irradiance.size() < 2) return;
  const size_t texels = irradiance[0].size();
  planes.first_bounce = irradiance[1];
  for (float& value : planes.first_bounce.values) value /= static_cast<float>(kPi);
  for (size_t a = 0; a < kJudgedAlbedos.size(); ++a) {
    planes.all_bounces[a] = Grid<float>(irradiance[0].width, irradiance[0].height);
    for (size_t i = 0; i < texels; ++i) {
      double sum = 0;
      for (size_t b = irradiance.size(); b-- > 0;)
        sum = sum * kJudgedAlbedos[a] + static_cast<double>(irradiance[b][i]);
      planes.all_bounces[a][i] = static_cast<float>(sum / kPi);
    }
  }
}

TracedPlanes trace_planes(const Tracer& tracer, int bounces) {
  LightTransport transport = trace_surface(tracer, bounces > 0);
  TracedPlanes traced;
  traced.planes.work = transport.counts.rays;
  if (bounces > 0) {
    BounceOptions options;
    options.bounces = bounces;
    traced.irradiance = bounce_light(transport, options).irradiance;
    add_bounces(traced.irradiance, traced.planes);
  }
  traced.planes.uniform = std::move(transport.visible_fraction);
  traced.planes.cosine = std::move(transport.direct_over_pi);
  return traced;
}

}  // namespace hemibake
