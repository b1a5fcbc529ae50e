#include <memory>

#include "surface/surface.h"
#include "tracers/embree/embree.h"
#include "tracers/march/march.h"
#include "tracers/slice/slice.h"
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

TradeRun ray_run(const RayOptions& rays, int bounces) {
  TradeRun run;
  run.method = bounces > kNoBounces ? "embree-light" : "embree";
  run.add_setting("rays", rays.rays);
  run.add_setting("directions", name_of(rays.directions));
  if (bounces > kNoBounces) run.add_setting("bounces", bounces);
  if (bounces > kNoBounces && rays.patch_kind == PatchKind::kTexels)
    run.add_setting("texel-links", name_of(rays.texel_links));
  run.abscissa_name = "rays";
  run.abscissa = rays.rays;
  run.perform = [rays, bounces](const Surface& surface, const Grid<float>&) {
    return trace_planes(*make_embree_tracer(surface, rays), bounces).planes;
  };
  return run;
}

TradeRun slice_run(const SliceOptions& slices, int bounces) {
  TradeRun run;
  run.method = bounces > kNoBounces ? "slice-light" : "slice";
  run.add_setting("azimuths", slices.azimuths);
  if (bounces > kNoBounces) run.add_setting("bounces", bounces);
  if (bounces > kNoBounces && slices.patch_kind == PatchKind::kTexels)
    run.add_setting("texel-links", name_of(slices.texel_links));
  run.abscissa_name = "azimuths";
  run.abscissa = slices.azimuths;
  run.perform = [slices, bounces](const Surface& surface, const Grid<float>&) {
    return trace_planes(*make_slice_tracer(surface, slices), bounces).planes;
  };
  return run;
}

TradeRun march_run(int rays) {
  TradeRun run;
  run.method = "march";
  run.series = "march";
  run.add_setting("rays", rays);
  run.abscissa_name = "rays";
  run.abscissa = rays;
  run.perform = [rays](const Surface& surface, const Grid<float>&) {
    MarchOptions march;
    march.rays = rays;
    return trace_planes(*make_march_tracer(surface, march), kNoBounces).planes;
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
    RayOptions rays;
    rays.rays = kCutRays;
    const double range_m = height_range_m(surface);
    if (range_m > 0) rays.max_distance_m = ranges * range_m;
    return trace_planes(*make_embree_tracer(surface, rays), kNoBounces).planes;
  };
  return run;
}

// Bakes the map with `factor` times as many texels a side, and resamples the planes to its own texels.
TradeRun resolution_run(double factor, int bounces) {
  SliceOptions slices;
  slices.azimuths = kPlainSlices;
  TradeRun run = slice_run(slices, bounces);
  run.method =
      std::string(factor < 1 ? "half" : "double") + "-resolution" + (bounces > kNoBounces ? "-light" : "");
  run.perform = [slices, factor, bounces](const Surface& surface, const Grid<float>&) {
    const Surface other = resample_surface(surface, factor);
    RunPlanes planes = trace_planes(*make_slice_tracer(other, slices), bounces).planes;
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
      RayOptions rays;
      rays.rays = count;
      rays.directions = directions;
      TradeRun run = ray_run(rays, kNoBounces);
      run.series = std::string("embree ") + name_of(directions);
      run.representative = directions == DirectionSet::kUniform && count == (quick ? 64 : 256);
      runs.push_back(std::move(run));
    }
  }
  // Azimuths are worth more than rays: a level for every doubling.
  for (int azimuths = 2; azimuths <= top_ao_azimuths(effort); azimuths *= quick ? 8 : 2) {
    SliceOptions slices;
    slices.azimuths = azimuths;
    TradeRun run = slice_run(slices, kNoBounces);
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
    RayOptions rays;
    rays.rays = count;
    TradeRun run = ray_run(rays, kTradeBounces);
    run.series = "embree-light";
    run.representative = count == (quick ? 16 : 256);
    runs.push_back(std::move(run));
  }
  for (int azimuths = 2; azimuths <= top_light_azimuths(effort); azimuths *= quick ? 4 : 2) {
    SliceOptions slices;
    slices.azimuths = azimuths;
    TradeRun run = slice_run(slices, kTradeBounces);
    run.series = "slice-light";
    run.representative = azimuths == (quick ? top_light_azimuths(effort) : kPlainSlices);
    runs.push_back(std::move(run));
  }
  const std::vector<int> bounces = quick ? std::vector<int>{1} : std::vector<int>{1, 2, 3, 5, 10, 20};
  for (const int count : bounces) {
    SliceOptions slices;
    slices.azimuths = quick ? top_light_azimuths(effort) : kPlainSlices;
    runs.push_back(slice_run(slices, count));
  }
  for (const TexelLinks links : {TexelLinks::kNearest, TexelLinks::kBilinear}) {
    RayOptions rays;
    rays.rays = quick ? 16 : 256;
    rays.patch_kind = PatchKind::kTexels;
    rays.texel_links = links;
    runs.push_back(ray_run(rays, kTradeBounces));
    SliceOptions slices;
    slices.azimuths = quick ? top_light_azimuths(effort) : kPlainSlices;
    slices.patch_kind = PatchKind::kTexels;
    slices.texel_links = links;
    runs.push_back(slice_run(slices, kTradeBounces));
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
