#include <memory>

#include "surface/surface.h"
#include "tracers/embree/embree.h"
#include "tracers/march/march.h"
#include "tracers/slice/slice.h"
#include "trade/ladder.h"
#include "trade/resample.h"
#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr int kNoBounces = 0;
constexpr int kCutRays = 256;     // of the runs cut short at a distance
constexpr int kPlainSlices = 32;  // azimuths of the runs that are about something else

// What a bake with this tracer answers.
RunPlanes trace_planes(const Tracer& tracer, int bounces) {
  LightTransport seen = trace_surface(tracer, bounces > kNoBounces);
  RunPlanes planes;
  planes.work = seen.counts.rays;
  if (bounces > kNoBounces) {
    BounceOptions options;
    options.bounces = bounces;
    add_bounces(bounce_light(seen, options).irradiance, planes);
  }
  planes.uniform = std::move(seen.visible_fraction);
  planes.cosine = std::move(seen.direct_over_pi);
  return planes;
}

const char* name_of(DirectionSet directions) {
  return directions == DirectionSet::kUniform ? "uniform" : "cosine";
}

TradeRun ray_run(const RayOptions& rays, int bounces) {
  TradeRun run;
  run.method = bounces > kNoBounces ? "embree-light" : "embree";
  run.settings["rays"] = rays.rays;
  run.settings["directions"] = name_of(rays.directions);
  if (bounces > kNoBounces) run.settings["bounces"] = bounces;
  if (bounces > kNoBounces && rays.patch_kind == PatchKind::kTexels)
    run.settings["texel-links"] = rays.texel_links == TexelLinks::kNearest ? "nearest" : "bilinear";
  run.abscissa_name = "rays";
  run.abscissa = rays.rays;
  run.perform = [rays, bounces](const Surface& surface, const Grid<float>&) {
    return trace_planes(*make_embree_tracer(surface, rays), bounces);
  };
  return run;
}

TradeRun slice_run(const SliceOptions& slices, int bounces) {
  TradeRun run;
  run.method = bounces > kNoBounces ? "slice-light" : "slice";
  run.settings["azimuths"] = slices.azimuths;
  if (bounces > kNoBounces) run.settings["bounces"] = bounces;
  if (bounces > kNoBounces && slices.patch_kind == PatchKind::kTexels)
    run.settings["texel-links"] = slices.texel_links == TexelLinks::kNearest ? "nearest" : "bilinear";
  run.abscissa_name = "azimuths";
  run.abscissa = slices.azimuths;
  run.perform = [slices, bounces](const Surface& surface, const Grid<float>&) {
    return trace_planes(*make_slice_tracer(surface, slices), bounces);
  };
  return run;
}

TradeRun march_run(int rays) {
  TradeRun run;
  run.method = "march";
  run.series = "march";
  run.settings["rays"] = rays;
  run.abscissa_name = "rays";
  run.abscissa = rays;
  run.perform = [rays](const Surface& surface, const Grid<float>&) {
    MarchOptions march;
    march.rays = rays;
    return trace_planes(*make_march_tracer(surface, march), kNoBounces);
  };
  return run;
}

// As artists do it: what lies farther than this many height ranges counts as sky.
TradeRun cut_run(double ranges) {
  TradeRun run;
  run.method = "cut";
  run.settings["rays"] = kCutRays;
  run.settings["max-distance-ranges"] = ranges;
  run.perform = [ranges](const Surface& surface, const Grid<float>&) {
    RayOptions rays;
    rays.rays = kCutRays;
    const double range_m = height_range_m(surface);
    if (range_m > 0) rays.max_distance_m = ranges * range_m;
    return trace_planes(*make_embree_tracer(surface, rays), kNoBounces);
  };
  return run;
}

// A bake of the map with `factor` times as many texels a side, brought back to the texels of this one.
TradeRun resolution_run(double factor, int bounces) {
  SliceOptions slices;
  slices.azimuths = kPlainSlices;
  TradeRun run = slice_run(slices, bounces);
  run.method =
      std::string(factor < 1 ? "half" : "double") + "-resolution" + (bounces > kNoBounces ? "-light" : "");
  run.perform = [slices, factor, bounces](const Surface& surface, const Grid<float>&) {
    const Surface other = resample_surface(surface, factor);
    RunPlanes planes = trace_planes(*make_slice_tracer(other, slices), bounces);
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
    for (const int count : rungs(effort, 4, 4096, 64)) {
      RayOptions rays;
      rays.rays = count;
      rays.directions = directions;
      TradeRun run = ray_run(rays, kNoBounces);
      run.series = std::string("embree ") + name_of(directions);
      run.representative = directions == DirectionSet::kUniform && count == (quick ? 64 : 256);
      runs.push_back(std::move(run));
    }
  }
  // Azimuths are worth more than rays: a rung for every doubling.
  for (int azimuths = 2; azimuths <= top_ao_azimuths(effort); azimuths *= quick ? 8 : 2) {
    SliceOptions slices;
    slices.azimuths = azimuths;
    TradeRun run = slice_run(slices, kNoBounces);
    run.series = "slice";
    run.representative = azimuths == (quick ? top_ao_azimuths(effort) : kPlainSlices);
    runs.push_back(std::move(run));
  }
  for (const int count : rungs(effort, 16, 1024, 16)) {
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
  for (const int count : rungs(effort, 4, 1024, 16)) {
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
