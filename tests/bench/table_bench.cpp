// Every tracer on maps from 128² on: CPU seconds, rays (azimuths) per CPU second, links and bytes per link,
// peak memory, and the ratio to Embree at equal error. Errors are against many azimuths in the same run,
// where the map is small enough; on larger ones fewer settings are measured. The maps have the same detail
// per texel at every size. Each measurement is a process of its own, on one thread, so that its peak memory
// is its own.
//
//   hemibake_bench_table [SIDE…]     128 256 512 1024 by default, some minutes; 4096 takes a quarter of an
//   hour
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <span>
#include <stdexcept>
#include <string>

#include "bench/equal_error.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "support/threads.h"
#include "surface/synthetic/noise.h"
#include "tracers/embree/embree.h"
#include "tracers/march/march.h"
#include "tracers/slice/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

constexpr double kErrorWanted = 0.0025;
// Texels a side up to which all of it is measured: with errors, with links and errors, with links at all, and
// Embree without links.
constexpr int kLargestReference = 128, kLargestLinkReference = 128, kLargestLinks = 256, kLargestEmbree = 512;
constexpr int kReferenceAzimuths = 512, kReferenceLinkAzimuths = 256;

struct MapKind {
  const char* name;
  double longest_texels, shortest_texels, gain;  // waves of the noise
  double amplitude_texels;
};
constexpr MapKind kMapKinds[] = {{"rough", 32, 2, 0.7, 38}, {"smooth", 128, 16, 0.4, 115}};

Surface make_map(const MapKind& kind, int side) {
  FractalNoise noise;
  noise.frequency = side / kind.longest_texels;
  noise.highest_frequency = side / kind.shortest_texels;
  noise.gain = kind.gain;
  Grid<float> heights(side, side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      heights(x, y) =
          static_cast<float>(0.5 + 0.5 * fractal_noise((x + 0.5) / side, (y + 0.5) / side, Tile{}, noise));
  return make_surface(std::move(heights), side, kind.amplitude_texels, Edge::kWrap);
}

using MakeTracer = std::function<std::unique_ptr<Tracer>(const Surface&)>;

struct Setting {
  std::string name;
  bool with_links;
  MakeTracer make_tracer;
};

MakeTracer slices(int azimuths, uint64_t seed = 0) {
  return [=](const Surface& surface) {
    SliceOptions options;
    options.azimuths = azimuths;
    options.seed = seed;
    return make_slice_tracer(surface, options);
  };
}

MakeTracer rays(int count, DirectionSet directions) {
  return [=](const Surface& surface) {
    RayOptions options;
    options.rays = count;
    options.directions = directions;
    return make_embree_tracer(surface, options);
  };
}

MakeTracer marches(int count) {
  return [=](const Surface& surface) {
    MarchOptions options;
    options.rays = count;
    return make_march_tracer(surface, options);
  };
}

// What a measuring process hands back, in memory it shares with this one.
struct Numbers {
  double cpu_seconds;  // of tracing
  uint64_t rays, links, link_bytes;
};

struct Run {
  Numbers numbers{};
  double peak_mib = 0;
  std::vector<float> uniform, direct, bounced;  // α, E₀/π, E₁/π
};

void measure(const MapKind& kind, int side, const Setting& setting, Numbers& numbers,
             std::span<float> planes) {
  set_thread_count(1);
  const Surface surface = make_map(kind, side);
  const double start = process_cpu_seconds();
  const auto tracer = setting.make_tracer(surface);
  const LightTransport seen = trace_surface(*tracer, setting.with_links ? KeptLinks::kAll : KeptLinks::kNone);
  numbers.cpu_seconds = process_cpu_seconds() - start;
  numbers.rays = seen.counts.rays;
  const size_t texels = surface.texel_count();
  std::copy_n(seen.visible_fraction.values.begin(), texels, planes.begin());
  std::copy_n(seen.direct_over_pi.values.begin(), texels, planes.subspan(texels).begin());
  if (!setting.with_links) return;
  numbers.links = seen.final_gather.count() + seen.patch_form_factors.count();
  numbers.link_bytes = seen.final_gather.stored_bytes() + seen.patch_form_factors.stored_bytes();
  BounceOptions options;
  options.bounces = 1;
  const Bounces bounces = bounce_light(seen, options);
  for (size_t i = 0; i < texels; ++i)
    planes[2 * texels + i] = bounces.irradiance[1][i] / static_cast<float>(kPi);
}

Run run_apart(const MapKind& kind, int side, const Setting& setting) {
  const size_t texels = static_cast<size_t>(side) * static_cast<size_t>(side);
  const size_t bytes = sizeof(Numbers) + 3 * texels * sizeof(float);
  void* shared = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::bad_alloc();
  Numbers& numbers = *static_cast<Numbers*>(shared);
  const std::span<float> planes(reinterpret_cast<float*>(static_cast<char*>(shared) + sizeof(Numbers)),
                                3 * texels);
  std::fflush(stdout);
  const pid_t child = fork();
  if (child == 0) {
    measure(kind, side, setting, numbers, planes);
    _exit(0);
  }
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child || status != 0)
    throw std::runtime_error(fmt::format("{} on {}² came to a bad end", setting.name, side));
  Run run;
  run.numbers = numbers;
  run.peak_mib = static_cast<double>(usage.ru_maxrss) / 1024;
  const auto plane = [&](size_t k) {
    const auto part = planes.subspan(k * texels, texels);
    return std::vector<float>(part.begin(), part.end());
  };
  run.uniform = plane(0);
  run.direct = plane(1);
  run.bounced = plane(2);
  munmap(shared, bytes);
  return run;
}

void print_head() {
  fmt::print("{:22} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>9} {:>9} {:>9}\n", "", "cpu-s", "us/texel",
             "M/cpu-s", "links/px", "B/link", "MiB", "rms α", "rms E0/π", "rms E1/π");
}

// Prints one line; `reference` may be null.
void print_run(const std::string& name, const Run& run, const Run* reference, bool with_links) {
  const double texels = static_cast<double>(run.uniform.size());
  const Numbers& n = run.numbers;
  fmt::print("{:22} {:9.3f} {:9.3f} {:8.2f}", name, n.cpu_seconds, 1e6 * n.cpu_seconds / texels,
             1e-6 * static_cast<double>(n.rays) / n.cpu_seconds);
  if (with_links) {
    fmt::print(" {:8.1f} {:8.2f}", static_cast<double>(n.links) / texels,
               static_cast<double>(n.link_bytes) / static_cast<double>(n.links));
  } else {
    fmt::print(" {:>8} {:>8}", "", "");
  }
  fmt::print(" {:8.0f}", run.peak_mib);
  if (reference != nullptr) {
    fmt::print(" {:9.5f} {:9.5f}", rms_difference(run.uniform, reference->uniform),
               rms_difference(run.direct, reference->direct));
    if (with_links) fmt::print(" {:9.5f}", rms_difference(run.bounced, reference->bounced));
  }
  fmt::print("\n");
}

// Embree's CPU seconds over the slices', both where the rms error of `plane` is kErrorWanted. Embree takes
// the better of its direction sets.
void print_ratio(const char* name, const std::vector<Run>& by_slices,
                 const std::vector<std::vector<Run>>& by_rays, const Run& reference,
                 std::vector<float> Run::*plane) {
  const auto seconds = [&](const std::vector<Run>& runs) {
    std::vector<Measured> measured;
    for (const Run& run : runs)
      measured.push_back({run.numbers.cpu_seconds, rms_difference(run.*plane, reference.*plane)});
    return seconds_at_error(measured, kErrorWanted);
  };
  double embree = HUGE_VAL;
  for (const std::vector<Run>& runs : by_rays) embree = std::min(embree, seconds(runs));
  const double slice = seconds(by_slices);
  fmt::print("  at rms {} = {}: slice {:.3f} cpu-s, embree {:.3f} cpu-s, ratio {:.1f}\n", name, kErrorWanted,
             slice, embree, embree / slice);
}

void compare_sky(const MapKind& kind, int side) {
  fmt::print("\n{} {}², sky only\n", kind.name, side);
  print_head();
  const bool with_reference = side <= kLargestReference;
  Run reference;
  if (with_reference) reference = run_apart(kind, side, {"reference", false, slices(kReferenceAzimuths, 99)});
  const auto run = [&](const std::string& name, const MakeTracer& make_tracer) {
    Run result = run_apart(kind, side, {name, false, make_tracer});
    print_run(name, result, with_reference ? &reference : nullptr, false);
    return result;
  };
  std::vector<Run> by_slices;
  for (const int azimuths : {32, 64})
    by_slices.push_back(run(fmt::format("slice {}", azimuths), slices(azimuths)));
  if (side > kLargestEmbree) return;
  if (!with_reference) {
    run("embree 64 uniform", rays(64, DirectionSet::kUniform));
    return;
  }
  run("march 256", marches(256));
  std::vector<std::vector<Run>> by_rays;
  for (const DirectionSet set : {DirectionSet::kUniform, DirectionSet::kCosine}) {
    by_rays.emplace_back();
    for (const int count : {256, 1024})
      by_rays.back().push_back(
          run(fmt::format("embree {} {}", count, set == DirectionSet::kUniform ? "uniform" : "cosine"),
              rays(count, set)));
  }
  print_ratio("α", by_slices, by_rays, reference, &Run::uniform);
  print_ratio("E0/π", by_slices, by_rays, reference, &Run::direct);
}

void compare_links(const MapKind& kind, int side) {
  fmt::print("\n{} {}², with links\n", kind.name, side);
  print_head();
  if (side > kLargestLinkReference) {
    print_run("slice 64", run_apart(kind, side, {"slice 64", true, slices(64)}), nullptr, true);
    return;
  }
  const Run reference = run_apart(kind, side, {"reference", true, slices(kReferenceLinkAzimuths, 99)});
  const auto run = [&](const std::string& name, const MakeTracer& make_tracer) {
    Run result = run_apart(kind, side, {name, true, make_tracer});
    print_run(name, result, &reference, true);
    return result;
  };
  std::vector<Run> by_slices, by_rays;
  for (const int azimuths : {32, 64})
    by_slices.push_back(run(fmt::format("slice {}", azimuths), slices(azimuths)));
  for (const int count : {256, 1024})
    by_rays.push_back(run(fmt::format("embree {} uniform", count), rays(count, DirectionSet::kUniform)));
  print_ratio("E1/π", by_slices, {by_rays}, reference, &Run::bounced);
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  std::vector<int> sides;
  for (int i = 1; i < argc; ++i) sides.push_back(std::atoi(argv[i]));
  if (sides.empty()) sides = {128, 256, 512, 1024};
  for (const hemibake::MapKind& kind : hemibake::kMapKinds)
    for (const int side : sides) {
      hemibake::compare_sky(kind, side);
      if (side <= hemibake::kLargestLinks) hemibake::compare_links(kind, side);
    }
}
