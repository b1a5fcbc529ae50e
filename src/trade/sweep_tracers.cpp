#include <memory>

#include "bake/settings.h"
#include "surface/surface.h"
#include "trade/resample.h"
#include "trade/sweep.h"

namespace hemibake {
namespace {

constexpr int kNoBounces = 0;
constexpr int kCutRays = 256;     // rays of the runs cut short at a distance
constexpr int kPlainSlices = 32;  // azimuths of the runs that vary something else

const char* name_of(DirectionSet directions) {
  return directions == DirectionSet::kUniform ? "uniform" : "cosine";
}

const char* name_of(TexelLinks links) { return links == TexelLinks::kNearest ? "nearest" : "bilinear"; }

// Describes a bake. settings: with tracer and rays.
TradeRun tracer_run(const BakeSettings& settings) {
  const bool slices = settings.tracer == TracerKind::kSlice, light = settings.bounces > kNoBounces;
  TradeRun run;
  run.method = std::string(slices ? "slice" : "embree") + (light ? "-light" : "");
  run.abscissa_name = slices ? "azimuths" : "rays";
  run.abscissa = *settings.rays;
  run.add_setting(run.abscissa_name, *settings.rays);
  if (!slices) run.add_setting("directions", name_of(settings.directions.value_or(DirectionSet::kUniform)));
  if (light) run.add_setting("bounces", settings.bounces);
  if (light && settings.patch_kind == PatchKind::kTexels)
    run.add_setting("texel-links", name_of(settings.texel_links));
  run.perform = [settings](const Surface& surface, const Grid<float>&) {
    return bake_run(surface, settings).planes;
  };
  return run;
}

BakeSettings settings_of(TracerKind tracer, int rays, int bounces) {
  BakeSettings settings;
  settings.tracer = tracer;
  settings.rays = rays;
  settings.bounces = bounces;
  return settings;
}

TradeRun march_run(int rays) {
  TradeRun run;
  run.method = "march";
  run.series = "march";
  run.add_setting("rays", rays);
  run.abscissa_name = "rays";
  run.abscissa = rays;
  run.perform = [rays](const Surface& surface, const Grid<float>&) {
    return bake_run(surface, settings_of(TracerKind::kMarch, rays, kNoBounces)).planes;
  };
  return run;
}

// Takes all farther than `ranges` height ranges for sky, as artists do it.
TradeRun cut_run(double ranges) {
  TradeRun run;
  run.method = "cut";
  run.add_setting("rays", kCutRays);
  run.add_setting("max-distance-ranges", ranges);
  run.perform = [ranges](const Surface& surface, const Grid<float>&) {
    BakeSettings settings = settings_of(TracerKind::kEmbree, kCutRays, kNoBounces);
    const double range_m = height_range_m(surface);
    if (range_m > 0) settings.max_distance_m = ranges * range_m;
    return bake_run(surface, settings).planes;
  };
  return run;
}

// Bakes the map with `factor` times as many texels a side, and resamples the planes to its own texels.
TradeRun resolution_run(double factor, int bounces) {
  const BakeSettings settings = settings_of(TracerKind::kSlice, kPlainSlices, bounces);
  TradeRun run = tracer_run(settings);
  run.method =
      std::string(factor < 1 ? "half" : "double") + "-resolution" + (bounces > kNoBounces ? "-light" : "");
  run.perform = [settings, factor](const Surface& surface, const Grid<float>&) {
    const Surface other = resample_surface(surface, factor);
    RunPlanes planes = bake_run(other, settings).planes;
    for (const NamedPlane& named : named_planes())
      if (Grid<float>& plane = named.of(planes); !plane.empty())
        plane = resample_plane(plane, surface.width(), surface.height(), surface.edge);
    return planes;
  };
  return run;
}

void add_ao_runs(Effort effort, std::vector<TradeRun>& runs) {
  const bool quick = effort == Effort::kQuick;
  for (const DirectionSet directions : {DirectionSet::kUniform, DirectionSet::kCosine}) {
    for (const int count : sweep_levels(effort, 4, 4096, 64)) {
      BakeSettings settings = settings_of(TracerKind::kEmbree, count, kNoBounces);
      settings.directions = directions;
      TradeRun run = tracer_run(settings);
      run.series = std::string("embree ") + name_of(directions);
      run.representative = directions == DirectionSet::kUniform && count == (quick ? 64 : 256);
      runs.push_back(std::move(run));
    }
  }
  // Azimuths are worth more than rays: a level for every doubling.
  for (int azimuths = 2; azimuths <= top_ao_azimuths(effort); azimuths *= quick ? 8 : 2) {
    TradeRun run = tracer_run(settings_of(TracerKind::kSlice, azimuths, kNoBounces));
    run.series = "slice";
    run.representative = azimuths == (quick ? top_ao_azimuths(effort) : kPlainSlices);
    runs.push_back(std::move(run));
  }
  for (const int count : sweep_levels(effort, 16, 1024, 16)) {
    TradeRun run = march_run(count);
    run.representative = count == (quick ? 16 : 256);
    runs.push_back(std::move(run));
  }
  const std::vector<double> cuts =
      quick ? std::vector<double>{1} : std::vector<double>{0.125, 0.25, 0.5, 1, 2, 4, 8};
  for (const double ranges : cuts) {
    TradeRun run = cut_run(ranges);
    run.representative = ranges == 1;
    runs.push_back(std::move(run));
  }
}

void add_light_runs(Effort effort, bool can_halve, std::vector<TradeRun>& runs) {
  const bool quick = effort == Effort::kQuick;
  for (const int count : sweep_levels(effort, 4, 1024, 16)) {
    TradeRun run = tracer_run(settings_of(TracerKind::kEmbree, count, kTradeBounces));
    run.series = "embree-light";
    run.representative = count == (quick ? 16 : 256);
    runs.push_back(std::move(run));
  }
  for (int azimuths = 2; azimuths <= top_light_azimuths(effort); azimuths *= quick ? 4 : 2) {
    TradeRun run = tracer_run(settings_of(TracerKind::kSlice, azimuths, kTradeBounces));
    run.series = "slice-light";
    run.representative = azimuths == (quick ? top_light_azimuths(effort) : kPlainSlices);
    runs.push_back(std::move(run));
  }
  const std::vector<int> bounces = quick ? std::vector<int>{1} : std::vector<int>{1, 2, 3, 5, 10, 20};
  const int azimuths = quick ? top_light_azimuths(effort) : kPlainSlices;
  for (const int count : bounces)
    runs.push_back(tracer_run(settings_of(TracerKind::kSlice, azimuths, count)));
  for (const TexelLinks links : {TexelLinks::kNearest, TexelLinks::kBilinear}) {
    for (const TracerKind tracer : {TracerKind::kEmbree, TracerKind::kSlice}) {
      const int rays = tracer == TracerKind::kSlice ? azimuths : quick ? 16 : 256;
      BakeSettings settings = settings_of(tracer, rays, kTradeBounces);
      settings.patch_kind = PatchKind::kTexels;
      settings.texel_links = links;
      runs.push_back(tracer_run(settings));
    }
  }
  for (const int count : {kNoBounces, kTradeBounces}) {
    if (can_halve) runs.push_back(resolution_run(0.5, count));
    if (!quick) runs.push_back(resolution_run(2, count));
  }
}

}  // namespace

void add_tracer_runs(Effort effort, bool can_halve, std::vector<TradeRun>& runs) {
  add_ao_runs(effort, runs);
  add_light_runs(effort, can_halve, runs);
}

}  // namespace hemibake
