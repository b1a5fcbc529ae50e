// What the tracer adds to Embree: CPU seconds of the tracing loop over those of a bare loop of the same rays
// through the same triangles with nothing stored; and of 20 bounces over the tracing. Ratios from one run.
//
//   hemibake_bench_embree [SIDE] [RAYS]     texels along a side (360), rays per receiver (256)
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench/bare_scene.h"
#include "bench/bench_maps.h"
#include "core/parallel.h"
#include "tracers/embree/embree.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

// The texels' rays, as the tracer shoots them, up to the border of the scene. Rays that start above the
// relief are left out: the tracer does not trace them either.
std::vector<RTCRay> texel_rays(const Surface& surface, const Tracer& tracer, uint32_t texel) {
  const double top = height_range_m(surface) / surface.texel_size_m;
  std::vector<RTCRay> rays;
  const int x = static_cast<int>(texel) % surface.width(), y = static_cast<int>(texel) / surface.width();
  for (const RayRecord& record : tracer.replay_texel(texel)) {
    const RTCRay ray = texel_ray(surface, top, x, y, record.direction);
    if (ray.tfar > 0) rays.push_back(ray);
  }
  return rays;
}

double bare_cpu_seconds(const Surface& surface, const Tracer& tracer, bool occlusion, uint64_t& hits) {
  const BareScene bare(surface);
  double seconds = 0;
  for (uint32_t texel = 0; texel < surface.texel_count(); ++texel) {
    std::vector<RTCRay> rays = texel_rays(surface, tracer, texel);
    const double start = process_cpu_seconds();
    for (RTCRay& ray : rays) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      if (occlusion) {
        rtcOccluded1(bare.scene, &context, &ray);
        hits += ray.tfar < 0;
      } else {
        RTCRayHit query;
        query.ray = ray;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(bare.scene, &context, &query);
        hits += query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
      }
    }
    seconds += process_cpu_seconds() - start;
  }
  return seconds;
}

double traced_cpu_seconds(const Surface& surface, const Tracer& tracer, bool with_links) {
  Row row;
  TracerCounts counts;
  const double start = process_cpu_seconds();
  for (uint32_t texel = 0; texel < surface.texel_count(); ++texel)
    tracer.trace_texel(texel, with_links, row, counts);
  return process_cpu_seconds() - start;
}

void run(const BenchMap& map, int rays) {
  RayOptions options;
  options.rays = rays;
  const auto tracer = make_embree_tracer(map.surface, options);
  uint64_t hits = 0, occluded = 0;
  const double bare_hits = bare_cpu_seconds(map.surface, *tracer, false, hits);
  const double with_links = traced_cpu_seconds(map.surface, *tracer, true);
  const double bare_occlusion = bare_cpu_seconds(map.surface, *tracer, true, occluded);
  const double ao_only = traced_cpu_seconds(map.surface, *tracer, false);
  const double million_rays = 1e-6 * rays * map.surface.texel_count();
  fmt::print("{:16} {:8.2f} {:8.2f} {:8.2f}   {:8.2f} {:8.2f} {:8.2f}\n", map.name, million_rays / bare_hits,
             million_rays / with_links, with_links / bare_hits, million_rays / bare_occlusion,
             million_rays / ao_only, ao_only / bare_occlusion);

  const double before = process_cpu_seconds();
  const LightTransport seen = trace_surface(*tracer, KeptLinks::kAll);
  const double traced = process_cpu_seconds();
  bounce_light(seen, {});
  const double bounced = process_cpu_seconds();
  fmt::print("{:16} bake with facets {:.2f} cpu-s, 20 bounces {:.2f} cpu-s: {:.1f} %\n", "", traced - before,
             bounced - traced, 100 * (bounced - traced) / (traced - before));
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  const int side = argc > 1 ? std::atoi(argv[1]) : 360;
  const int rays = argc > 2 ? std::atoi(argv[2]) : 256;
  fmt::print("{}x{} texels, {} rays; Mray per cpu-s\n", side, side, rays);
  fmt::print("{:16} {:>8} {:>8} {:>8}   {:>8} {:>8} {:>8}\n", "map", "bare", "links", "ratio", "bare occ",
             "ao only", "ratio");
  for (const hemibake::BenchMap& map : hemibake::bench_maps(side)) hemibake::run(map, rays);
}
