#include "trade/reference.h"

#include <algorithm>
#include <cmath>

#include "bake/plan.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "tracers/slice/slice.h"
#include "trade/errors.h"
#include "trade/resample.h"

namespace hemibake {
namespace {

constexpr uint64_t kFirstSeed = 1000003;  // of no run
constexpr int kStartFactor = 4;           // times the azimuths of the highest level
constexpr int kLargestFactor = 16;
constexpr int kMostPairs = 4;                        // of seeds
constexpr double kAimedShare = kReferenceShare / 2;  // some run may be better than the slices' highest level
constexpr size_t kFittedBounces = 21;                // E_0 … E_20, what a bake stores

// Up to 1024 turned azimuths, all slices lie on one grid of directions whatever their seed, so two seeds err
// alike. Odd numbers of azimuths that differ have no direction in common.
int odd_azimuths(int azimuths, uint64_t seed) {
  return seed < kFirstSeed ? azimuths : azimuths + 1 + 2 * static_cast<int>(seed - kFirstSeed);
}

// Bakes with slices; keeps E_0 … E_20 of the bounces.
BakedRun bake_slices(const Surface& surface, int azimuths, int bounces, uint64_t seed) {
  BakeSettings settings;
  settings.tracer = TracerKind::kSlice;
  settings.rays = odd_azimuths(azimuths, seed);
  settings.seed = seed;
  settings.bounces = bounces;
  BakedRun run = bake_run(surface, settings);
  run.irradiance.resize(std::min(run.irradiance.size(), kFittedBounces));
  return run;
}

// Makes the bake that models are fitted to and the referee checks.
Bake bake_of(const Surface& surface, BakedRun&& traced) {
  Bake bake;
  bake.width = surface.width();
  bake.height = surface.height();
  bake.irradiance = std::move(traced.irradiance);
  bake.visible_fraction = std::move(traced.planes.uniform);
  return bake;
}

// Two groups of seeds, summed plane by plane.
struct Groups {
  std::array<std::vector<std::vector<double>>, 2> sums;
  RunPlanes shape;
  int pairs = 0;

  void add_pair(const RunPlanes& a, const RunPlanes& b) {
    shape = a;
    ++pairs;
    add(a, sums[0]);
    add(b, sums[1]);
  }
  static void add(const RunPlanes& planes, std::vector<std::vector<double>>& sum) {
    sum.resize(kPlaneCount);
    for (size_t p = 0; p < sum.size(); ++p) {
      const Grid<float>& plane = named_planes()[p].of(planes);
      sum[p].resize(plane.size());
      for (size_t i = 0; i < plane.size(); ++i) sum[p][i] += static_cast<double>(plane[i]);
    }
  }
  RunPlanes mean() const {
    RunPlanes planes = shape;
    for (size_t p = 0; p < kPlaneCount; ++p) {
      Grid<float>& plane = named_planes()[p].of(planes);
      for (size_t i = 0; i < plane.size(); ++i)
        plane[i] = static_cast<float>((sums[0][p][i] + sums[1][p][i]) / (2 * pairs));
    }
    return planes;
  }
  // Returns the standard error of the mean: rms(A − B)/2.
  double error(size_t p) const {
    const size_t count = sums[0][p].size();
    if (count == 0) return 0;
    double squares = 0;
    for (size_t i = 0; i < count; ++i) {
      const double half = (sums[0][p][i] - sums[1][p][i]) / (2 * pairs);
      squares += half * half;
    }
    return std::sqrt(squares / static_cast<double>(count));
  }
};

// Errors of the reference and, without it, of the best run; 0 where the planes are empty.
struct Precision {
  PlaneValues error{}, best{};
  bool reached = true;
};

Precision precision_of(const Groups& groups, const RunPlanes& best_run) {
  const RunPlanes mean = groups.mean();
  Precision precision;
  for (size_t p = 0; p < kPlaneCount; ++p) {
    const NamedPlane& named = named_planes()[p];
    const Grid<float>& plane = named.of(mean);
    if (plane.empty()) continue;
    const double own = precision.error[p] = groups.error(p);
    const double seen = error_of(named.of(best_run).values, plane.values, {}).rmse;
    precision.best[p] = own_error(seen, own);
    if (own > std::max(kAimedShare * precision.best[p], kRoundingError)) precision.reached = false;
  }
  return precision;
}

size_t link_bytes(const Surface& surface, int azimuths) {
  SliceOptions slices;
  slices.azimuths = odd_azimuths(azimuths, kFirstSeed);
  slices.seed = kFirstSeed;
  return plan_bake(surface, *make_slice_tracer(surface, slices), {}).link_bytes;
}

std::vector<RefereeRow> check_means(const Surface& surface, const Bake& bake, bool quick) {
  RefereeCheckOptions options;
  options.texels = std::min<size_t>(quick ? 100 : 1000, surface.texel_count());
  options.paths = quick ? 128 : 1024;
  if (options.texels < 2) return {};
  return check_against_referee(surface, {bake.visible_fraction, bake.irradiance}, options).means;
}

// Converges α and E₀/π: doubles the azimuths until they are enough.
RunPlanes converge_sky(const Surface& surface, int top, ReferenceFacts& facts) {
  const RunPlanes best_run = bake_slices(surface, top, 0, 0).planes;
  for (int factor = kStartFactor;; factor *= 2) {
    Groups groups;
    groups.add_pair(bake_slices(surface, factor * top, 0, kFirstSeed).planes,
                    bake_slices(surface, factor * top, 0, kFirstSeed + 1).planes);
    const Precision precision = precision_of(groups, best_run);
    if (!precision.reached && factor < kLargestFactor) continue;
    facts.azimuths_ao = factor * top;
    facts.error = precision.error;
    facts.best_run_error = precision.best;
    return groups.mean();
  }
}

// Converges the bounces: doubles the azimuths while their links fit, then adds seeds.
RunPlanes converge_light(const Surface& surface, const ReferenceOptions& options, Bake& bake,
                         ReferenceFacts& facts) {
  const int top = top_light_azimuths(options.effort);
  const RunPlanes best_run = bake_slices(surface, top, kTradeBounces, 0).planes;
  int factor = kStartFactor;
  while (factor > 1 && link_bytes(surface, factor * top) > options.memory_bytes) factor /= 2;
  Groups groups;
  while (true) {
    const uint64_t seed = kFirstSeed + 2 * static_cast<uint64_t>(groups.pairs);
    BakedRun a = bake_slices(surface, factor * top, kReferenceBounces, seed);
    groups.add_pair(a.planes, bake_slices(surface, factor * top, kReferenceBounces, seed + 1).planes);
    bake = bake_of(surface, std::move(a));
    const Precision precision = precision_of(groups, best_run);
    const bool may_double = factor < kLargestFactor && groups.pairs == 1 &&
                            link_bytes(surface, 2 * factor * top) <= options.memory_bytes;
    if (!precision.reached && may_double) {
      factor *= 2;
      groups = {};
      continue;
    }
    if (!precision.reached && groups.pairs < kMostPairs) continue;
    facts.azimuths_light = factor * top;
    facts.seeds_light = 2 * groups.pairs;
    for (size_t p = kFirstPlane; p < kPlaneCount; ++p) {  // α and E₀/π have better ones
      facts.error[p] = precision.error[p];
      facts.best_run_error[p] = precision.best[p];
    }
    return groups.mean();
  }
}

}  // namespace

double own_error(double rmse, double reference_error) {
  return std::sqrt(std::max(0.0, rmse * rmse - reference_error * reference_error));
}

Reference make_reference(const Surface& surface, const ReferenceOptions& options) {
  const double start = process_cpu_seconds();
  Reference reference;
  ReferenceFacts& facts = reference.facts;
  facts.width = surface.width();
  facts.height = surface.height();
  facts.can_halve = can_halve(surface);
  facts.height_range_m = height_range_m(surface);
  facts.texel_size_m = surface.texel_size_m;

  RunPlanes sky = converge_sky(surface, top_ao_azimuths(options.effort), facts);
  Bake bake;
  reference.planes = converge_light(surface, options, bake, facts);
  facts.referee = check_means(surface, bake, options.effort == Effort::kQuick);
  bake.visible_fraction = sky.uniform;
  facts.models = fit_light_models(make_curves(bake, 100));

  reference.planes.uniform = std::move(sky.uniform);
  reference.planes.cosine = std::move(sky.cosine);
  for (size_t p = 0; p < kPlaneCount; ++p)
    facts.mean[p] = mean(std::span<const float>(named_planes()[p].of(reference.planes).values));
  facts.cpu_seconds = process_cpu_seconds() - start;
  facts.models_on_true_ao = light_model_errors(reference.planes, facts.models, reference.planes);
  return reference;
}

}  // namespace hemibake
