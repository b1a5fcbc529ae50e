#include "reference/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/confidence.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/statistics.h"
#include "reference/path_step.h"
#include "reference/random.h"
#include "reference/ray_caster.h"

namespace hemibake {
namespace {

struct Path {
  SurfacePoint at;
  double weight;
};
using Group = std::array<Path, kRefereeGroupPaths>;

struct RayCounts {
  uint64_t rays = 0;
  uint64_t truncated = 0;
};

void check_options(const RefereeOptions& options) {
  if (options.paths < 1)
    throw InputError(fmt::format("referee paths {}, expected at least 1", options.paths));
  if (options.bounces < 0)
    throw InputError(fmt::format("referee bounces {}, expected 0 or more", options.bounces));
  if (!(options.lift_texels > 0))
    throw InputError(fmt::format("referee lift {} texels, expected more than 0", options.lift_texels));
  for (const RefereeTotal& total : options.totals) {
    if (!(total.albedo >= 0 && total.albedo <= 1))
      throw InputError(fmt::format("referee albedo {}, expected 0..1", total.albedo));
    if (total.last_bounce != RefereeTotal::kUnlimited && total.last_bounce < options.bounces)
      throw InputError(
          fmt::format("referee total ends at bounce {}, expected at least the {} measured one by one",
                      total.last_bounce, options.bounces));
  }
}

uint32_t group_count(const RefereeOptions& options) {
  const auto paths = static_cast<uint32_t>(options.paths);
  return std::max(2u, (paths + kRefereeGroupPaths - 1) / kRefereeGroupPaths);
}

bool reaches(const RefereeTotal& total, int bounce) {
  return total.last_bounce == RefereeTotal::kUnlimited || bounce <= total.last_bounce;
}

class PathTracer {
 public:
  PathTracer(const Surface& surface, const RefereeOptions& options)
      : caster_(surface),
        options_(options),
        quantities_(options.bounces + 1 + static_cast<int>(options.totals.size())),
        lift_(caster_.start_lift(options.lift_texels)) {}

  const HeightFieldRayCaster& caster() const { return caster_; }
  int quantities() const { return quantities_; }

  // Writes one independent estimate of every quantity into `out`. Weights of `group` sum to 1.
  void measure_group(Group& group, RefereeRandom& random, std::span<double> out, RayCounts& counts) const {
    std::fill(out.begin(), out.end(), 0.0);
    Group hits;
    for (int bounce = 0;; ++bounce) {
      size_t hit_count = 0;
      double escaped = 0;
      for (const Path& path : group) {
        SurfacePoint hit;
        if (trace_on(path.at, random, hit, counts))
          hits[hit_count++] = {hit, path.weight};
        else
          escaped += path.weight;
      }
      out[static_cast<size_t>(bounce)] = escaped;
      for (size_t k = 0; k < options_.totals.size(); ++k)
        total(out, k) += escaped * std::pow(options_.totals[k].albedo, bounce);
      const std::span<const Path> survivors(hits.data(), hit_count);
      if (bounce == options_.bounces) return finish(survivors, random, out, counts);
      if (survivors.empty()) return;
      resample(survivors, random, group);
    }
  }

 private:
  double& total(std::span<double> out, size_t k) const {
    return out[static_cast<size_t>(options_.bounces) + 1 + k];
  }

  // Casts a ray of the path on. Returns whether it hits.
  bool trace_on(const SurfacePoint& from, RefereeRandom& random, SurfacePoint& hit, RayCounts& counts) const {
    const PathStep step = step_path(caster_, from, lift_, random);
    hit = step.hit;
    counts.rays += step.rays;
    counts.truncated += step.outcome == RayOutcome::kTruncated;
    return step.outcome == RayOutcome::kHit;
  }

  static void resample(std::span<const Path> survivors, RefereeRandom& random, Group& group) {
    double sum = 0;
    for (const Path& path : survivors) sum += path.weight;
    const double share = sum / kRefereeGroupPaths, offset = random.uniform();
    size_t source = 0;
    double passed = survivors[0].weight;  // weight of the survivors up to `source`
    for (size_t i = 0; i < kRefereeGroupPaths; ++i) {
      const double mark = (static_cast<double>(i) + offset) * share;
      while (passed < mark && source + 1 < survivors.size()) passed += survivors[++source].weight;
      group[i] = {survivors[source].at, share};
    }
  }

  // Follows each path on its own to the end, for the totals.
  void finish(std::span<const Path> survivors, RefereeRandom& random, std::span<double> out,
              RayCounts& counts) const {
    for (const Path& path : survivors) {
      SurfacePoint at = path.at;
      double weight = path.weight;
      for (int bounce = options_.bounces + 1;; ++bounce) {
        // The path survives with the largest share of light that any total still takes.
        double survival = 0;
        for (const RefereeTotal& wanted : options_.totals)
          if (reaches(wanted, bounce)) survival = std::max(survival, wanted.albedo);
        if (survival == 0 || (survival < 1 && random.uniform() >= survival)) break;
        // ρᵇ of the bounces before the first roulette is in the totals: until there the path lost nothing.
        weight /= survival;
        SurfacePoint hit;
        if (!trace_on(at, random, hit, counts)) {
          for (size_t k = 0; k < options_.totals.size(); ++k)
            if (reaches(options_.totals[k], bounce))
              total(out, k) += weight * std::pow(options_.totals[k].albedo, bounce);
          break;
        }
        at = hit;
      }
    }
  }

  HeightFieldRayCaster caster_;
  const RefereeOptions& options_;
  int quantities_;
  double lift_;
};

// Measures one group. start(random): returns where each of its paths begins.
template <class Start>
void run_group(const PathTracer& tracer, RefereeRandom random, const Start& start, std::span<double> out,
               RayCounts& counts) {
  Group group;
  for (Path& path : group) path = {start(random), 1.0 / kRefereeGroupPaths};
  tracer.measure_group(group, random, out, counts);
}

double variance_of_mean(const Moments& moments) {
  const auto n = static_cast<double>(moments.count);
  return moments.sum_squared_deviations / (n - 1) / n;
}

RefereeEstimates make_estimates(int quantities, uint32_t groups, size_t receivers) {
  RefereeEstimates estimates;
  estimates.quantities = quantities;
  estimates.groups = groups;
  estimates.mean.resize(receivers * static_cast<size_t>(quantities));
  estimates.variance.resize(estimates.mean.size());
  return estimates;
}

void add_counts(std::span<const RayCounts> counts, RefereeEstimates& estimates) {
  for (const RayCounts& c : counts) {
    estimates.rays += c.rays;
    estimates.truncated_rays += c.truncated;
  }
}

}  // namespace

RefereeEstimates referee_texels(const Surface& surface, std::span<const uint32_t> texels,
                                const RefereeOptions& options) {
  check_options(options);
  const PathTracer tracer(surface, options);
  const auto quantities = static_cast<size_t>(tracer.quantities());
  RefereeEstimates estimates = make_estimates(tracer.quantities(), group_count(options), texels.size());
  std::vector<RayCounts> counts(texels.size());
  Progress progress("refereeing", texels.size(), "texel");
  parallel_for(texels.size(), 1, [&](size_t begin, size_t end) {
    std::vector<double> out(quantities);
    for (size_t i = begin; i < end; ++i) {
      const uint32_t texel = texels[i];
      const SurfacePoint receiver = texel_center(surface, texel);
      std::vector<Moments> moments(quantities);
      for (uint32_t g = 0; g < estimates.groups; ++g) {
        run_group(
            tracer, {options.seed, texel, g}, [&](RefereeRandom&) { return receiver; }, out, counts[i]);
        for (size_t q = 0; q < quantities; ++q) moments[q].add(out[q]);
      }
      for (size_t q = 0; q < quantities; ++q) {
        estimates.mean[i * quantities + q] = moments[q].mean;
        estimates.variance[i * quantities + q] = variance_of_mean(moments[q]);
      }
      progress.advance(1);
    }
  });
  add_counts(counts, estimates);
  return estimates;
}

std::vector<double> referee_visible_fractions(const Surface& surface, std::span<const uint32_t> texels,
                                              int rays, uint64_t seed) {
  if (rays < 1) throw InputError(fmt::format("referee rays {}, expected at least 1", rays));
  const HeightFieldRayCaster caster(surface);
  const double lift = caster.start_lift(RefereeOptions().lift_texels);
  const int side = static_cast<int>(std::ceil(std::sqrt(rays)));
  constexpr uint64_t kFractionGroup = ~uint64_t{0};
  std::vector<double> fractions(texels.size());
  parallel_for(texels.size(), 16, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      RefereeRandom random(seed, texels[i], kFractionGroup);
      const SurfacePoint receiver = texel_center(surface, texels[i]);
      const glm::dvec3 start = receiver.position + glm::dvec3(0, 0, lift);
      int visible = 0;
      for (int cell = 0; cell < side * side; ++cell) {
        const glm::dvec3 direction =
            uniform_direction(receiver.normal, (cell / side + random.uniform()) / side,
                              (cell % side + random.uniform()) / side);
        SurfacePoint hit;
        visible += reaches_sky(caster.cast(start, direction, hit));
      }
      fractions[i] = static_cast<double>(visible) / (side * side);
    }
  });
  return fractions;
}

RefereeEstimates referee_area(const Surface& surface, const RefereeOptions& options) {
  check_options(options);
  const PathTracer tracer(surface, options);
  const HeightFieldRayCaster& caster = tracer.caster();
  // Cumulative area: a uniform number finds a facet by its area.
  std::vector<double> area(caster.facet_count());
  double sum = 0;
  for (uint32_t f = 0; f < caster.facet_count(); ++f)
    area[f] = sum += 0.5 / caster.point_on_facet(f, 0, 0).normal.z;
  const auto start = [&](RefereeRandom& random) {
    const auto found = std::upper_bound(area.begin(), area.end() - 1, random.uniform() * sum);
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    return caster.point_on_facet(static_cast<uint32_t>(found - area.begin()), u, v);
  };

  constexpr uint64_t kAreaReceiver = ~uint64_t{0};
  constexpr size_t kGrain = 16;  // groups
  const auto quantities = static_cast<size_t>(tracer.quantities());
  const uint32_t groups = group_count(options);
  std::vector<double> out(groups * quantities);
  std::vector<RayCounts> counts(groups);
  Progress progress("refereeing", groups, "group");
  parallel_for(groups, kGrain, [&](size_t begin, size_t end) {
    for (size_t g = begin; g < end; ++g)
      run_group(tracer, {options.seed, kAreaReceiver, g}, start, {&out[g * quantities], quantities},
                counts[g]);
    progress.advance(end - begin);
  });

  RefereeEstimates estimates = make_estimates(tracer.quantities(), groups, 1);
  for (size_t q = 0; q < quantities; ++q) {
    Moments moments;
    for (uint32_t g = 0; g < groups; ++g) moments.add(out[g * quantities + q]);
    estimates.mean[q] = moments.mean;
    estimates.variance[q] = variance_of_mean(moments);
  }
  add_counts(counts, estimates);
  return estimates;
}

RefereeInterval referee_interval(const RefereeEstimates& estimates, size_t receiver, int quantity,
                                 double confidence) {
  const size_t i = estimates.index(receiver, quantity);
  return {estimates.mean[i],
          student_quantile(confidence, estimates.groups - 1.0) * std::sqrt(estimates.variance[i])};
}

}  // namespace hemibake
