// What the tracer adds to Embree: CPU seconds of the tracing loop over those of a bare loop of the same rays through
// the same triangles with nothing stored; and of 20 bounces over the tracing. Ratios from one run.
//
//   hemibake_bench_embree [SIDE] [RAYS]     texels along a side (360), rays per receiver (256)
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bench/bench_maps.h"
#include "core/parallel.h"
#include "tracers/embree.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

constexpr int kMargin = 64;  // as in tracers/embree.cpp

struct BareScene {
  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  explicit BareScene(const Surface& surface) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    const uint32_t columns = static_cast<uint32_t>(surface.width() + 2 * kMargin);
    const uint32_t rows = static_cast<uint32_t>(surface.height() + 2 * kMargin);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                                          size_t{columns + 1} * (rows + 1)));
    auto* t = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                                             size_t{2} * columns * rows));
    for (uint32_t j = 0; j <= rows; ++j)
      for (uint32_t i = 0; i <= columns; ++i) {
        const int x = static_cast<int>(i) - kMargin, y = static_cast<int>(j) - kMargin;
        *v++ = static_cast<float>(x);
        *v++ = static_cast<float>(y);
        *v++ = static_cast<float>(surface.heights_m(wrap_index(x, surface.width()), wrap_index(y, surface.height())) /
                                  surface.texel_size_m);
      }
    for (uint32_t j = 0; j < rows; ++j)
      for (uint32_t i = 0; i < columns; ++i) {
        const uint32_t c = j * (columns + 1) + i;
        for (const uint32_t index : {c, c + 1, c + columns + 1, c + columns + 2, c + columns + 1, c + 1}) *t++ = index;
      }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
  }
  ~BareScene() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

// The texels' rays, as the tracer shoots them, up to the border of the scene. Rays that start above the relief are
// left out: the tracer does not trace them either.
std::vector<RTCRay> texel_rays(const Surface& surface, const Tracer& tracer, uint32_t texel) {
  const double top = height_range_m(surface) / surface.texel_size_m;
  std::vector<RTCRay> rays;
  for (const RayRecord& record : tracer.replay_texel(texel)) {
    RTCRay ray{};
    ray.org_x = static_cast<float>(texel % static_cast<uint32_t>(surface.width()));
    ray.org_y = static_cast<float>(texel / static_cast<uint32_t>(surface.width()));
    ray.org_z = static_cast<float>(surface.heights_m[texel] / surface.texel_size_m + 1e-3);
    ray.dir_x = static_cast<float>(record.direction.x);
    ray.dir_y = static_cast<float>(record.direction.y);
    ray.dir_z = static_cast<float>(record.direction.z);
    const auto exit = [](double from, double along, double size) {
      return along > 0 ? (size + kMargin - 1 - from) / along : along < 0 ? (1 - kMargin - from) / along : HUGE_VAL;
    };
    double end = std::min(exit(ray.org_x, record.direction.x, surface.width()),
                          exit(ray.org_y, record.direction.y, surface.height()));
    if (record.direction.z > 0) end = std::min(end, (top - static_cast<double>(ray.org_z)) / record.direction.z * 1.0001);
    if (end <= 0) continue;
    ray.tfar = static_cast<float>(end);
    ray.mask = 0xffffffff;
    rays.push_back(ray);
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
  for (uint32_t texel = 0; texel < surface.texel_count(); ++texel) tracer.trace_texel(texel, with_links, row, counts);
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
             million_rays / with_links, with_links / bare_hits, million_rays / bare_occlusion, million_rays / ao_only,
             ao_only / bare_occlusion);

  const double before = process_cpu_seconds();
  const Visibility seen =
      trace_surface(*tracer, map.surface.width(), map.surface.height(), Patches::kFacets, true);
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
  fmt::print("{:16} {:>8} {:>8} {:>8}   {:>8} {:>8} {:>8}\n", "map", "bare", "links", "ratio", "bare occ", "ao only",
             "ratio");
  for (const hemibake::BenchMap& map : hemibake::bench_maps(side)) hemibake::run(map, rays);
}
