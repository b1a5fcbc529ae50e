#include "trade/reference.h"

#include <algorithm>
#include <cmath>

#include "bake/plan.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "reference/comparison.h"
#include "tracers/slice/slice.h"
#include "trade/errors.h"
#include "trade/resample.h"
#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr uint64_t kFirstSeed = 1000003;  // of no run
constexpr int kStartFactor = 4;           // times the azimuths of the highest rung
constexpr int kLargestFactor = 16;
constexpr int kMostPairs = 4;                        // of seeds
constexpr double kAimedShare = kReferenceShare / 2;  // some run may be better than the slices' highest rung
constexpr size_t kFittedBounces = 21;                // E_0 … E_20, what a bake stores

// Up to 1024 turned azimuths, all slices lie on one grid of directions whatever their seed, so two seeds err
// alike. Odd numbers of azimuths that differ have no direction in common.
SliceOptions seeded_slices(int azimuths, uint64_t seed) {
  SliceOptions options;
  options.azimuths = azimuths;
  if (seed >= kFirstSeed) options.azimuths += 1 + 2 * static_cast<int>(seed - kFirstSeed);
  options.seed = seed;
  return options;
}

RunPlanes see_sky(const Surface& surface, int azimuths, uint64_t seed) {
  const auto tracer = make_slice_tracer(surface, seeded_slices(azimuths, seed));
  LightTransport seen = trace_surface(*tracer, false);
  RunPlanes planes;
  planes.uniform = std::move(seen.visible_fraction);
  planes.cosine = std::move(seen.direct_over_pi);
  return planes;
}

struct Lit {
  RunPlanes planes;
  Bake bake;  // E_0 … E_20, for fits and the referee
};

Lit light_up(const Surface& surface, int azimuths, int bounces, uint64_t seed) {
  const auto tracer = make_slice_tracer(surface, seeded_slices(azimuths, seed));
  LightTransport seen = trace_surface(*tracer, true);
  BounceOptions options;
  options.bounces = bounces;
  std::vector<Grid<float>> irradiance = bounce_light(seen, options).irradiance;
  Lit lit;
  add_bounces(irradiance, lit.planes);
  irradiance.resize(std::min(irradiance.size(), kFittedBounces));
  lit.bake.width = surface.width();
  lit.bake.height = surface.height();
  lit.bake.irradiance = std::move(irradiance);
  lit.bake.visible_fraction = std::move(seen.visible_fraction);
  lit.planes.uniform = lit.bake.visible_fraction;
  lit.planes.cosine = std::move(seen.direct_over_pi);
  return lit;
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
    sum.resize(named_planes().size());
    for (size_t p = 0; p < sum.size(); ++p) {
      const Grid<float>& plane = named_planes()[p].of(planes);
      sum[p].resize(plane.size());
      for (size_t i = 0; i < plane.size(); ++i) sum[p][i] += static_cast<double>(plane[i]);
    }
  }
  RunPlanes mean() const {
    RunPlanes planes = shape;
    for (size_t p = 0; p < named_planes().size(); ++p) {
      Grid<float>& plane = named_planes()[p].of(planes);
      for (size_t i = 0; i < plane.size(); ++i)
        plane[i] = static_cast<float>((sums[0][p][i] + sums[1][p][i]) / (2 * pairs));
    }
    return planes;
  }
  // Of the mean: rms(A − B)/2.
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

// Per plane: the error of the reference, and that of the best run without it.
struct Precision {
  nlohmann::ordered_json error, best;
  bool reached = true;
};

Precision precision_of(const Groups& groups, const RunPlanes& best_run) {
  const RunPlanes mean = groups.mean();
  Precision precision;
  for (size_t p = 0; p < named_planes().size(); ++p) {
    const NamedPlane& named = named_planes()[p];
    const Grid<float>& plane = named.of(mean);
    if (plane.empty()) continue;
    const double own = groups.error(p);
    const double seen = error_of(named.of(best_run).values, plane.values, {}).rmse;
    const double best = std::sqrt(std::max(0.0, seen * seen - own * own));
    precision.error[named.name] = own;
    precision.best[named.name] = best;
    // Where both are rounding there is nothing left to tell apart.
    constexpr double kRounding = 1e-6;
    if (own > std::max(kAimedShare * best, kRounding)) precision.reached = false;
  }
  return precision;
}

size_t link_bytes(const Surface& surface, int azimuths) {
  const auto tracer = make_slice_tracer(surface, seeded_slices(azimuths, kFirstSeed));
  return plan_bake(surface, *tracer, {}).link_bytes;
}

nlohmann::ordered_json ask_referee(const Surface& surface, const Bake& bake, bool quick) {
  RefereeCheckOptions options;
  options.texels = std::min<size_t>(quick ? 100 : 1000, surface.texel_count());
  options.paths = quick ? 128 : 1024;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  if (options.texels < 2) return rows;
  for (const RefereeRow& row :
       check_against_referee(surface, {bake.visible_fraction, bake.irradiance}, options).means)
    rows.push_back({{"quantity", row.quantity},
                    {"reference", row.bake_mean},
                    {"referee", row.referee_mean},
                    {"bias", row.bias},
                    {"half_width", row.half_width},
                    {"texels", row.texels}});
  return rows;
}

// α and E₀/π: azimuths are doubled until they are enough.
Groups converge_sky(const Surface& surface, int top, nlohmann::ordered_json& facts) {
  const RunPlanes best_run = see_sky(surface, top, 0);
  for (int factor = kStartFactor;; factor *= 2) {
    Groups groups;
    groups.add_pair(see_sky(surface, factor * top, kFirstSeed),
                    see_sky(surface, factor * top, kFirstSeed + 1));
    const Precision precision = precision_of(groups, best_run);
    if (!precision.reached && factor < kLargestFactor) continue;
    facts["azimuths_ao"] = factor * top;
    facts["error"] = precision.error;
    facts["best_run_error"] = precision.best;
    return groups;
  }
}

// The bounces: azimuths are doubled while their links fit, then seeds are added.
Groups converge_light(const Surface& surface, const ReferenceOptions& options, Bake& bake,
                      nlohmann::ordered_json& facts) {
  const int top = top_light_azimuths(options.effort);
  const RunPlanes best_run = light_up(surface, top, kTradeBounces, 0).planes;
  int factor = kStartFactor;
  while (factor > 1 && link_bytes(surface, factor * top) > options.memory_bytes) factor /= 2;
  Groups groups;
  while (true) {
    const uint64_t seed = kFirstSeed + 2 * static_cast<uint64_t>(groups.pairs);
    Lit a = light_up(surface, factor * top, kReferenceBounces, seed);
    const Lit b = light_up(surface, factor * top, kReferenceBounces, seed + 1);
    groups.add_pair(a.planes, b.planes);
    bake = std::move(a.bake);
    const Precision precision = precision_of(groups, best_run);
    const bool may_double = factor < kLargestFactor && groups.pairs == 1 &&
                            link_bytes(surface, 2 * factor * top) <= options.memory_bytes;
    if (!precision.reached && may_double) {
      factor *= 2;
      groups = {};
      continue;
    }
    if (!precision.reached && groups.pairs < kMostPairs) continue;
    facts["azimuths_light"] = factor * top;
    facts["seeds_light"] = 2 * groups.pairs;
    for (const NamedPlane& named : named_planes()) {
      if (facts["error"].contains(named.name)) continue;  // α and E₀/π have better ones
      facts["error"][named.name] = precision.error[named.name];
      facts["best_run_error"][named.name] = precision.best[named.name];
    }
    return groups;
  }
}

}  // namespace

Reference make_reference(const Surface& surface, const ReferenceOptions& options) {
  const double start = process_cpu_seconds();
  Reference reference;
  nlohmann::ordered_json& facts = reference.facts;
  facts["width"] = surface.width();
  facts["height"] = surface.height();
  facts["can_halve"] = can_halve(surface);
  facts["height_range_m"] = height_range_m(surface);
  facts["texel_size_m"] = surface.texel_size_m;
  facts["bounces"] = kReferenceBounces;

  const RunPlanes sky = converge_sky(surface, top_ao_azimuths(options.effort), facts).mean();
  Bake bake;
  reference.planes = converge_light(surface, options, bake, facts).mean();
  reference.planes.uniform = sky.uniform;
  reference.planes.cosine = sky.cosine;
  for (const NamedPlane& named : named_planes())
    facts["mean"][named.name] = mean(std::span<const float>(named.of(reference.planes).values));
  facts["referee"] = ask_referee(surface, bake, options.effort == Effort::kQuick);

  bake.visible_fraction = sky.uniform;
  reference.fitted = fit_light_models(make_curves(bake, 100));
  facts["models"] = json_from_fitted(reference.fitted);
  facts["cpu_seconds"] = process_cpu_seconds() - start;
  return reference;
}

}  // namespace hemibake
