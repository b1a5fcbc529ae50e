#include "trade/run_planes.h"

#include <fmt/format.h>

#include "bake/bake.h"
#include "core/constants.h"
#include "transport/series.h"

namespace hemibake {

const std::array<NamedPlane, kPlaneCount>& named_planes() {
  static const std::array<NamedPlane, kPlaneCount> planes = [] {
    std::array<NamedPlane, kPlaneCount> all;
    all[kAoPlane] = {"ao", "uniform visible fraction", &RunPlanes::uniform, 0};
    all[kDirectPlane] = {"direct", "E0/pi, the cosine-weighted visible fraction", &RunPlanes::cosine, 0};
    all[kFirstPlane] = {"first", "E1/pi, one bounce at albedo 1", &RunPlanes::first_bounce, 0};
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a)
      all[kLightPlanes + a] = {fmt::format("light.{:02.0f}", 100 * kJudgedAlbedos[a]),
                               fmt::format("E/pi, all bounces at albedo {:g}", kJudgedAlbedos[a]), nullptr,
                               a};
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
    for (size_t i = 0; i < texels; ++i)
      planes.all_bounces[a][i] = static_cast<float>(sum_bounces(irradiance, i, kJudgedAlbedos[a]) / kPi);
  }
}

BakedRun bake_run(const Surface& surface, BakeSettings settings) {
  settings.outputs = {BakeOutput::kAo};
  if (settings.bounces > 0) settings.outputs.push_back(BakeOutput::kIrradiance);
  settings.keep_transport = true;
  settings.limit_memory = settings.estimate_errors = false;
  settings.bounce_albedo.reset();
  MapSettings unused;
  resolve_defaults(unused, settings, [](const std::string&) { return true; });
  LoadedMap map;
  map.surface = surface;
  BakeResult baked = bake(map, settings, current_context());
  BakedRun run;
  run.irradiance = std::move(baked.planes.irradiance);
  add_bounces(run.irradiance, run.planes);
  run.planes.uniform = std::move(baked.planes.visible_fraction);
  run.planes.cosine = std::move(baked.transport->direct_over_pi);
  run.planes.work = baked.counts.rays;
  return run;
}

}  // namespace hemibake
