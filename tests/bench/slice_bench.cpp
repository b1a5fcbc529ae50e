// CPU seconds of the slice tracer over Embree's at equal rms error: of α and E₀/π without links, of E₁/π with
// links. Everything is measured in one run, against a slice reference with many azimuths; Embree is given the
// better of its direction sets and, without links, of single rays and packets of 16 neighbouring texels.
//
//   hemibake_bench_slice [MAP] [SIDE]     wall (WallHeight at 0.1 m), or bricks, shapes, noise at SIDE texels
//   (360)
#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <string>

#include "bench/bare_scene.h"
#include "bench/equal_error.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "io/image_io.h"
#include "sampling/directions.h"
#include "support/maps.h"
#include "support/threads.h"
#include "surface/frame.h"
#include "tracers/embree/embree.h"
#include "tracers/slice/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

constexpr double kErrorWanted = 0.0025;

struct Planes {
  std::vector<float> uniform, direct, bounced;  // α, E₀/π, E₁/π; the last one only with links
  double cpu_seconds;                           // of tracing
};

Planes trace(const Tracer& tracer, bool with_links) {
  const double start = process_cpu_seconds();
  const LightTransport seen = trace_surface(tracer, with_links ? KeptLinks::kAll : KeptLinks::kNone);
  Planes planes{seen.visible_fraction.values, seen.direct_over_pi.values, {}, process_cpu_seconds() - start};
  if (with_links) {
    BounceOptions options;
    options.bounces = 1;
    planes.bounced = bounce_light(seen, options).irradiance[1].values;
    for (float& value : planes.bounced) value /= static_cast<float>(kPi);
  }
  return planes;
}

Planes slices(const Surface& surface, int azimuths, bool with_links, uint64_t seed = 0) {
  SliceOptions options;
  options.azimuths = azimuths;
  options.seed = seed;
  return trace(*make_slice_tracer(surface, options), with_links);
}

Planes rays(const Surface& surface, int count, DirectionSet set, bool with_links) {
  RayOptions options;
  options.rays = count;
  options.directions = set;
  return trace(*make_embree_tracer(surface, options), with_links);
}

double seconds_at_wanted_error(const std::vector<Measured>& runs) {
  return seconds_at_error(runs, kErrorWanted);
}

// Rays per CPU second in packets of 16 neighbours over single rays, both through a bare scene.
double packet_gain(const Surface& surface) {
  const BareScene bare(surface);
  const double top = height_range_m(surface) / surface.texel_size_m;
  const auto directions = make_directions(DirectionSet::kUniform, 64, 180);
  double seconds[2] = {0, 0};
  for (const bool packets : {false, true}) {
    const double begin = process_cpu_seconds();
    for (int y = 0; y < surface.height(); y += 4) {
      for (int x = 0; x + 16 <= surface.width(); x += 16) {
        for (const WeightedDirection& direction : directions) {
          alignas(64) RTCRay16 sixteen{};
          for (int l = 0; l < 16; ++l) {
            const Frame frame = frame_about(glm::dvec3(surface.normals(x + l, y)));
            const glm::dvec3 d = frame.world_from_tangent(glm::dvec3(direction.local));
            const RTCRay ray = texel_ray(surface, top, x + l, y, d);
            if (!packets) {
              RTCRay single = ray;
              RTCIntersectContext context;
              rtcInitIntersectContext(&context);
              if (single.tfar > 0) rtcOccluded1(bare.scene, &context, &single);
              continue;
            }
            sixteen.org_x[l] = ray.org_x;
            sixteen.org_y[l] = ray.org_y;
            sixteen.org_z[l] = ray.org_z;
            sixteen.dir_x[l] = ray.dir_x;
            sixteen.dir_y[l] = ray.dir_y;
            sixteen.dir_z[l] = ray.dir_z;
            sixteen.tfar[l] = ray.tfar;
            sixteen.mask[l] = 0xffffffff;
          }
          if (!packets) continue;
          alignas(64) int valid[16];
          for (int l = 0; l < 16; ++l) valid[l] = sixteen.tfar[l] > 0 ? -1 : 0;
          RTCIntersectContext context;
          rtcInitIntersectContext(&context);
          context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
          rtcOccluded16(valid, bare.scene, &context, &sixteen);
        }
      }
    }
    seconds[packets] = process_cpu_seconds() - begin;
  }
  return seconds[0] / seconds[1];
}

void compare_sky(const Surface& surface) {
  const Planes reference = slices(surface, 512, false, 99);
  const double gain = packet_gain(surface);
  fmt::print("packets of 16 texels trace {:.2f} times the rays of single ones\n", gain);
  fmt::print("{:24} {:>8} {:>10} {:>10}\n", "without links", "cpu-s", "rms α", "rms E0/π");
  std::vector<Measured> best[2][2];
  const auto add = [&](const std::string& name, const Planes& planes, std::vector<Measured>* runs) {
    runs[0].push_back({planes.cpu_seconds, rms_difference(planes.uniform, reference.uniform)});
    runs[1].push_back({planes.cpu_seconds, rms_difference(planes.direct, reference.direct)});
    fmt::print("{:24} {:8.3f} {:10.5f} {:10.5f}\n", name, planes.cpu_seconds, runs[0].back().error,
               runs[1].back().error);
  };
  for (const int azimuths : {16, 32, 64, 128})
    add(fmt::format("slice {}", azimuths), slices(surface, azimuths, false), best[0]);
  double embree[2] = {HUGE_VAL, HUGE_VAL};
  for (const DirectionSet set : {DirectionSet::kUniform, DirectionSet::kCosine}) {
    std::vector<Measured> runs[2];
    for (const int count : {256, 1024})
      add(fmt::format("embree {} {}", count, set == DirectionSet::kUniform ? "uniform" : "cosine"),
          rays(surface, count, set, false), runs);
    for (int k = 0; k < 2; ++k) embree[k] = std::min(embree[k], seconds_at_wanted_error(runs[k]));
  }
  const char* names[2] = {"α", "E0/π"};
  for (int k = 0; k < 2; ++k) {
    const double slice = seconds_at_wanted_error(best[0][k]), rays_best = embree[k] / std::max(1.0, gain);
    fmt::print("rms {} = {}: slice {:.3f} cpu-s, embree {:.2f} cpu-s, ratio {:.1f}\n", names[k], kErrorWanted,
               slice, rays_best, rays_best / slice);
  }
}

void compare_links(const Surface& surface) {
  const Planes reference = slices(surface, 256, true, 99);
  fmt::print("{:24} {:>8} {:>10}\n", "with links", "cpu-s", "rms E1/π");
  const auto run = [&](const std::string& name, const Planes& planes) {
    const Measured measured{planes.cpu_seconds, rms_difference(planes.bounced, reference.bounced)};
    fmt::print("{:24} {:8.3f} {:10.5f}\n", name, measured.cpu_seconds, measured.error);
    return measured;
  };
  std::vector<Measured> by_slices, by_rays;
  for (const int azimuths : {16, 32, 64, 96})
    by_slices.push_back(run(fmt::format("slice {}", azimuths), slices(surface, azimuths, true)));
  for (const int count : {256, 1024})
    by_rays.push_back(
        run(fmt::format("embree {} uniform", count), rays(surface, count, DirectionSet::kUniform, true)));
  const double slice = seconds_at_wanted_error(by_slices), embree = seconds_at_wanted_error(by_rays);
  fmt::print("rms E1/π = {}: slice {:.2f} cpu-s, embree {:.2f} cpu-s, ratio {:.1f}\n", kErrorWanted, slice,
             embree, embree / slice);
}

Surface bench_surface(const std::string& name, int side) {
  if (name == "wall")
    return make_surface(read_height_map(HEMIBAKE_REFERENCE_DIR "/WallHeight.png", "G"), 1, 0.1, Edge::kWrap);
  if (name == "bricks") return synthetic_surface(SyntheticKind::kBricks, side, side);
  if (name == "noise") return synthetic_surface(SyntheticKind::kNoise, side, side);
  return synthetic_surface(SyntheticKind::kShapes, side, side, 0.45);
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "shapes";
  const hemibake::Surface surface = hemibake::bench_surface(name, argc > 2 ? std::atoi(argv[2]) : 360);
  hemibake::set_thread_count(1);
  fmt::print("{} {}x{}\n", name, surface.width(), surface.height());
  hemibake::compare_sky(surface);
  hemibake::compare_links(surface);
}
