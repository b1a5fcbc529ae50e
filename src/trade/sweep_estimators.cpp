#include <algorithm>

#include "core/constants.h"
#include "estimators/estimator.h"
#include "trade/sweep.h"

namespace hemibake {
namespace {

RunPlanes planes_of(Estimate&& estimate) {
  RunPlanes planes;
  (estimate.kind == AoKind::kUniform ? planes.uniform : planes.cosine) = std::move(estimate.ao);
  planes.known = std::move(estimate.known);
  planes.work = estimate.work;
  return planes;
}

TradeRun disk_run(const DiskOptions& disk) {
  TradeRun run;
  run.method = "disk";
  run.add_setting("passes", disk.passes);
  run.add_setting("opening", disk.opening_ratio);
  if (disk.vertex_area == VertexArea::kAverage) run.add_setting("area", "average");
  run.perform = [disk](const Surface& surface, const Grid<float>&) {
    return planes_of(estimate_disk(surface, disk));
  };
  return run;
}

TradeRun robust_run(const DiskRobustOptions& disk) {
  const DiskRobustOptions plain;
  TradeRun run;
  run.method = "disk-robust";
  run.add_setting("passes", disk.passes);
  run.add_setting("opening", disk.opening_ratio);
  if (disk.robust != plain.robust) run.add_setting("last-pass", "disks");
  if (disk.triangle_attenuation != plain.triangle_attenuation)
    run.add_setting("triangle-attenuation", disk.triangle_attenuation);
  if (disk.distance_attenuation_per_m != plain.distance_attenuation_per_m)
    run.add_setting("distance-attenuation", disk.distance_attenuation_per_m);
  run.perform = [disk](const Surface& surface, const Grid<float>&) {
    return planes_of(estimate_disk_robust(surface, disk));
  };
  return run;
}

const char* name_of(BlurPasses blur) {
  switch (blur) {
    case BlurPasses::kNone:
      return "none";
    case BlurPasses::kRows:
      return "rows";
    default:
      return "both";
  }
}

// radius_factor: times the radius that alchemy takes by itself.
TradeRun alchemy_run(const AlchemyOptions& alchemy, double radius_factor) {
  TradeRun run;
  run.method = "alchemy";
  run.add_setting("taps", alchemy.taps);
  run.add_setting("blur", name_of(alchemy.blur));
  if (radius_factor != 1) run.add_setting("radius-factor", radius_factor);
  if (alchemy.projection == Projection::kPerspective) run.add_setting("camera", "perspective");
  run.abscissa_name = "taps";
  run.abscissa = alchemy.taps;
  run.perform = [alchemy, radius_factor](const Surface& surface, const Grid<float>&) {
    AlchemyOptions options = alchemy;
    options.radius_m = radius_factor * alchemy_radius_m(surface, alchemy);
    return planes_of(estimate_alchemy(surface, options));
  };
  return run;
}

TradeRun horizon_run(const HorizonOptions& horizon) {
  TradeRun run;
  run.method = horizon.kind == AoKind::kCosine ? "horizon" : "horizon-uniform";
  run.add_setting("azimuths", horizon.azimuths);
  run.add_setting("steps", horizon.steps);
  run.abscissa_name = "azimuths";
  run.abscissa = horizon.azimuths;
  run.perform = [horizon](const Surface& surface, const Grid<float>&) {
    return planes_of(estimate_horizon(surface, horizon));
  };
  return run;
}

// Bunnell's indirect light on top of the true E₀, so that only the transfer between disks is judged.
TradeRun disk_light_run(int bounces, int shadow_passes) {
  TradeRun run;
  run.method = "disk-light";
  run.add_setting("bounces", bounces);
  run.add_setting("shadow-passes", shadow_passes);
  run.perform = [bounces, shadow_passes](const Surface& surface, const Grid<float>& direct) {
    DiskLightOptions light;
    light.bounces = bounces;
    light.shadow_passes = shadow_passes;
    RunPlanes planes;
    add_bounces(disk_light(surface, direct, {}, light), planes);
    return planes;
  };
  return run;
}

void add_disk_runs(bool quick, std::vector<TradeRun>& runs) {
  const std::vector<int> passes = quick ? std::vector<int>{2} : std::vector<int>{1, 2, 3, 4};
  for (const int count : passes) {
    DiskOptions disk;
    disk.passes = count;
    runs.push_back(disk_run(disk));
    runs.back().representative = count == 2;
  }
  for (const int count : passes) {
    DiskRobustOptions disk;
    disk.passes = count;
    runs.push_back(robust_run(disk));
    runs.back().representative = count == (quick ? 2 : 3);
  }
  if (quick) return;
  for (const double ratio : {0.1, 0.4, 0.8}) {
    DiskOptions disk;
    disk.opening_ratio = ratio;
    runs.push_back(disk_run(disk));
    DiskRobustOptions robust;
    robust.opening_ratio = ratio;
    runs.push_back(robust_run(robust));
  }
  DiskOptions average;
  average.vertex_area = VertexArea::kAverage;
  runs.push_back(disk_run(average));
  DiskRobustOptions only_disks, creases, depths, near;
  only_disks.robust = false;
  creases.triangle_attenuation = 0;
  depths.triangle_attenuation = 2;
  near.distance_attenuation_per_m = 1;
  for (const DiskRobustOptions& robust : {only_disks, creases, depths, near})
    runs.push_back(robust_run(robust));
}

void add_alchemy_runs(Effort effort, std::vector<TradeRun>& runs) {
  const bool quick = effort == Effort::kQuick;
  for (const int taps : sweep_levels(effort, 4, 128, 16)) {
    AlchemyOptions alchemy;
    alchemy.taps = taps;
    TradeRun run = alchemy_run(alchemy, 1);
    run.series = "alchemy";
    run.representative = taps == 16;
    runs.push_back(std::move(run));
  }
  for (const BlurPasses blur : {BlurPasses::kNone, BlurPasses::kRows}) {
    AlchemyOptions alchemy;
    alchemy.blur = blur;
    runs.push_back(alchemy_run(alchemy, 1));
    runs.back().keeps_planes = true;  // with the representative one: every stage of the blur
  }
  if (!quick)
    for (const double factor : {0.25, 0.5, 2.0, 4.0}) runs.push_back(alchemy_run({}, factor));
  AlchemyOptions seen;
  seen.projection = Projection::kPerspective;
  runs.push_back(alchemy_run(seen, 1));
}

void add_horizon_runs(Effort effort, std::vector<TradeRun>& runs) {
  const bool quick = effort == Effort::kQuick;
  for (const AoKind kind : {AoKind::kCosine, AoKind::kUniform}) {
    for (const int azimuths : sweep_levels(effort, 2, 32, 8)) {
      for (const int steps : sweep_levels(effort, 2, 32, 8)) {
        HorizonOptions horizon;
        horizon.azimuths = azimuths;
        horizon.steps = steps;
        horizon.kind = kind;
        TradeRun run = horizon_run(horizon);
        // With many steps what is left of the error is the azimuths'.
        if (steps == (quick ? 8 : 32)) run.series = run.method;
        run.representative = azimuths == 8 && steps == 8;
        runs.push_back(std::move(run));
      }
    }
  }
}

}  // namespace

void add_estimator_runs(Effort effort, std::vector<TradeRun>& runs) {
  const bool quick = effort == Effort::kQuick;
  add_disk_runs(quick, runs);
  add_alchemy_runs(effort, runs);
  add_horizon_runs(effort, runs);
  for (const int bounces : quick ? std::vector<int>{1} : std::vector<int>{1, 2, 4, 8}) {
    for (const int shadow_passes : quick ? std::vector<int>{1} : std::vector<int>{0, 1}) {
      runs.push_back(disk_light_run(bounces, shadow_passes));
      runs.back().representative = shadow_passes == 1 && bounces == (quick ? 1 : 4);
    }
  }
}

}  // namespace hemibake
