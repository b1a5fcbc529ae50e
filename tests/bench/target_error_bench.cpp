// bake --target-error on five maps with held-out seeds: the error reached over every texel against that
// wanted, and the rays chosen against the fewest that would have done.
//
//   hemibake_bench_target_error [SIDE [ERROR]]     32 0.005
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bake/target_error.h"
#include "support/maps.h"
#include "tracers/embree/embree.h"
#include "tracers/slice/slice.h"
#include "trade/reference.h"
#include "trade/scored_run.h"

namespace hemibake {
namespace {

constexpr uint64_t kHeldOutSeeds[] = {101, 102, 103};

struct Case {
  const char* name;
  SyntheticKind kind;
  double amplitude_m;
};

// Largest rms error of α, E₀/π and E/π over the albedos, mean over the held-out seeds.
double error_with(const Surface& surface, BakeSettings settings, const RunPlanes& truth) {
  double sum = 0;
  for (const uint64_t seed : kHeldOutSeeds) {
    settings.seed = seed;
    RunPlanes planes = bake_run(surface, settings).planes;
    planes.first_bounce = {};
    double worst = 0;
    for (const auto& error : errors_of(planes, truth))
      if (error) worst = std::max(worst, error->rmse);
    sum += worst;
  }
  return sum / static_cast<double>(std::size(kHeldOutSeeds));
}

// The fewest rays below `chosen` in steps of a tenth that keep the error; `chosen` where none does.
int fewest_rays(const Surface& surface, BakeSettings settings, double error, const RunPlanes& truth) {
  int fewest = *settings.rays;
  while (fewest > 1) {
    const int fewer = std::min(fewest - 1, static_cast<int>(std::ceil(0.9 * fewest)));
    settings.rays = fewer;
    if (error_with(surface, settings, truth) > error) break;
    fewest = fewer;
  }
  return fewest;
}

void run(int side, double error) {
  for (const Case& c :
       {Case{"bricks 0.1 m", SyntheticKind::kBricks, 0.1},
        Case{"shapes 0.45 m", SyntheticKind::kShapes, 0.45},
        Case{"concrete 0.05 m", SyntheticKind::kConcrete, 0.05},
        Case{"noise 0.1 m", SyntheticKind::kNoise, 0.1}, Case{"bowl 0.3 m", SyntheticKind::kBowl, 0.3}}) {
    const Surface surface = synthetic_surface(c.kind, side, side, c.amplitude_m);
    const RunPlanes truth = make_reference(surface, {}).planes;
    for (const bool slices : {true, false}) {
      TargetOptions options;
      options.error = error;
      options.fewest_rays = slices ? 4 : 16;
      options.make_tracer = [&](int rays, uint64_t seed) {
        SliceOptions by_slices;
        by_slices.azimuths = rays;
        by_slices.seed = seed;
        RayOptions by_rays;
        by_rays.rays = rays;
        by_rays.seed = seed;
        return slices ? make_slice_tracer(surface, by_slices) : make_embree_tracer(surface, by_rays);
      };
      const TargetChoice choice = choose_for_target(surface, options);
      BakeSettings settings;
      settings.tracer = slices ? TracerKind::kSlice : TracerKind::kEmbree;
      settings.rays = choice.rays;
      settings.bounces = choice.bounces;
      const double reached = error_with(surface, settings, truth);
      const int fewest = fewest_rays(surface, settings, error, truth);
      fmt::print("{:16} {:6}: {:4} rays, {:3} bounces, reached {:.5f} = {:.2f} x; fewest {:4}: {:.2f} x\n",
                 c.name, slices ? "slice" : "embree", choice.rays, choice.bounces, reached, reached / error,
                 fewest, static_cast<double>(choice.rays) / fewest);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  hemibake::run(argc > 1 ? std::atoi(argv[1]) : 32, argc > 2 ? std::atof(argv[2]) : 0.005);
  return 0;
}
