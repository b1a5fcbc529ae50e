// Matrix products to a converged total at albedo 1, where every texel's light must become 1: bounce after
// bounce against what `bake --converge` does. A product is one reading of the patch links; tests of the
// texels and work on groups of patches count by the links they read. Plain bounces are made up to a cap; how
// many are missing then follows from what a bounce takes off the worst texel, measured over the second half
// of them.
//
//   hemibake_bench_converge [MAP] [TRACER RAYS]…     wall 64 and 256 rays of Embree, 32 slices by default
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bench/named_maps.h"
#include "core/parallel.h"
#include "transport/solver/orthomin.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr double kTolerance = 1e-5;
constexpr int kStored = 20;  // bounces a bake makes in any case
constexpr int kMostBounces = 400, kBouncesBetweenTests = 10;
constexpr int kMostSteps = 1000, kStepsBetweenTests = 4, kTestsBetweenLines = 5;

struct Errors {
  double worst = 0;
  size_t off = 0;  // by more than the tolerance

  explicit Errors(const std::vector<double>& light) {
    for (const double value : light) {
      const double error = std::abs(1 - value);
      worst = std::max(worst, error);
      off += error > kTolerance;
    }
  }
};

struct Cost {
  double products = 0, cpu_seconds = 0;
};

struct Light {
  const LightTransport& seen;
  std::vector<double> last, sum, next;

  explicit Light(const LightTransport& visibility)
      : seen(visibility), last(seen.patch_direct().begin(), seen.patch_direct().end()), sum(last) {}

  void bounce() {
    apply_transport(seen.bounce_matrix(), {}, last, next);
    last.swap(next);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += last[i];
  }
};

std::vector<double> texels_under(const LightTransport& seen, const std::vector<double>& patches) {
  std::vector<double> light(seen.final_gather.rows);
  multiply(seen.final_gather, patches, light);
  for (size_t i = 0; i < light.size(); ++i) light[i] += static_cast<double>(seen.direct_over_pi[i]);
  return light;
}

// Without the tests a bake makes.
Cost plain(const LightTransport& seen) {
  Light light(seen);
  double half_worst = 0, worst = 1, cpu = 0;
  int bounces = 0;
  while (worst > kTolerance && bounces < kMostBounces) {
    const double start = process_cpu_seconds();
    for (int i = 0; i < kBouncesBetweenTests; ++i) light.bounce();
    cpu += process_cpu_seconds() - start;
    bounces += kBouncesBetweenTests;
    worst = Errors(texels_under(seen, light.sum)).worst;
    if (bounces == kMostBounces / 2) half_worst = worst;
  }
  double all = bounces;
  if (worst > kTolerance)
    all += kMostBounces / 2 * std::log(worst / kTolerance) / std::log(half_worst / worst);
  fmt::print(
      "  plain: worst texel {:.1e} off after {} bounces{}\n", worst, bounces,
      worst > kTolerance ? fmt::format(", {:.0f} by what the last {} took off", all, kMostBounces / 2) : "");
  return {all, cpu * all / bounces};
}

Cost accelerated(const LightTransport& seen) {
  const double start = process_cpu_seconds();
  Light light(seen);
  for (int b = 0; b < kStored; ++b) light.bounce();
  apply_transport(seen.bounce_matrix(), {}, light.last, light.next);
  Orthomin solver(seen.bounce_matrix(), {}, std::move(light.sum), std::move(light.next));
  const double test =
      static_cast<double>(seen.final_gather.count()) / static_cast<double>(seen.bounce_matrix().count());
  Cost cost{kStored + 1, process_cpu_seconds() - start};
  bool goes_on = true;
  for (int steps = 0, tests = 0; goes_on && steps < kMostSteps;) {
    const double step_start = process_cpu_seconds(), work = solver.work();
    for (int i = 0; i < kStepsBetweenTests && goes_on; ++i, ++steps) goes_on = solver.step();
    cost.products += solver.work() - work;
    const bool tested = solver.largest_residual() <= 2 * kTolerance;
    const std::vector<double> texels = texels_under(seen, solver.light());
    const Errors of_texels(texels);
    if (tested) cost.products += test;
    cost.cpu_seconds += process_cpu_seconds() - step_start;
    goes_on = goes_on && of_texels.worst >= kTolerance;
    if (++tests % kTestsBetweenLines == 0 || !goes_on) {
      const Errors of_patches(solver.light());
      fmt::print(
          "  {:6.1f} products: worst texel {:.1e} off; off by more than {:.0e}: {:.3f} % of texels, "
          "{:.3f} % of patches\n",
          cost.products, of_texels.worst, kTolerance,
          100 * static_cast<double>(of_texels.off) / static_cast<double>(texels.size()),
          100 * static_cast<double>(of_patches.off) / static_cast<double>(solver.light().size()));
    }
  }
  return cost;
}

void run(const std::string& map, const std::string& tracer_name, int rays) {
  const Surface surface = bench_map(map);
  std::unique_ptr<Tracer> tracer;
  if (tracer_name == "slice") {
    SliceOptions options;
    options.azimuths = rays;
    tracer = make_slice_tracer(surface, options);
  } else {
    RayOptions options;
    options.rays = rays;
    tracer = make_embree_tracer(surface, options);
  }
  const LightTransport seen = trace_surface(*tracer, KeptLinks::kAll);
  fmt::print("{}, {} {}: {:.1f} M patches, {:.1f} M links between them\n", map, tracer_name, rays,
             1e-6 * seen.bounce_matrix().rows, 1e-6 * static_cast<double>(seen.bounce_matrix().count()));
  const Cost fast = accelerated(seen), slow = plain(seen);
  fmt::print("  products {:.1f} against {:.0f}: 1/{:.1f}; cpu-s {:.1f} against {:.1f}: 1/{:.1f}\n",
             fast.products, slow.products, slow.products / fast.products, fast.cpu_seconds, slow.cpu_seconds,
             slow.cpu_seconds / fast.cpu_seconds);
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  const std::string map = argc > 1 ? argv[1] : "wall";
  if (argc > 3) {
    for (int i = 2; i + 1 < argc; i += 2) hemibake::run(map, argv[i], std::atoi(argv[i + 1]));
    return 0;
  }
  hemibake::run(map, "embree", 64);
  hemibake::run(map, "embree", 256);
  hemibake::run(map, "slice", 32);
}
