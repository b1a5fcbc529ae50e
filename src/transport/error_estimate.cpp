#include "transport/error_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

constexpr uint32_t kSample = 2048;  // texels, and nodes, traced again
constexpr uint64_t kSampleStream = 0xe440;
constexpr int kHalfBounces = 12;  // at albedo ½ the rest is below 10⁻³ of the first bounce
constexpr size_t kBins = 50;

// One at random in each of equal strata of [0, count).
std::vector<uint32_t> sample_places(uint32_t count) {
  std::vector<uint32_t> places(std::min(count, kSample));
  for (uint32_t i = 0; i < places.size(); ++i) {
    const double place =
        (i + unit_interval(mix_bits(0, kSampleStream, i))) / static_cast<double>(places.size());
    places[i] = std::min(count - 1, static_cast<uint32_t>(place * count));
  }
  return places;
}

// Two measurements of the same: their difference has twice the variance of one.
struct Noise {
  Moments ao, direct, first, ao_direct, ao_first;
};

double deviation(const Moments& squares) { return std::sqrt(squares.mean / 2); }

// The sampled texels again, with the same light of the patches.
Noise trace_again(const Tracer& again, const Visibility& seen, const Bounces& bounces) {
  const std::vector<uint32_t> texels = sample_places(static_cast<uint32_t>(seen.direct_over_pi.size()));
  struct Difference {
    double ao, direct, first;
  };
  std::vector<Difference> differences(texels.size());
  parallel_for(texels.size(), 16, [&](size_t begin, size_t end) {
    Row row;
    TracerCounts counts;
    for (size_t i = begin; i < end; ++i) {
      const uint32_t texel = texels[i];
      again.trace_texel(texel, true, row, counts);
      double first = 0;
      for (const Link& link : row.links)
        first += static_cast<double>(link.weight) * static_cast<double>(seen.patch_direct()[link.patch]);
      differences[i] = {row.visible_fraction - static_cast<double>(seen.visible_fraction[texel]),
                        row.direct_over_pi - static_cast<double>(seen.direct_over_pi[texel]),
                        first - static_cast<double>(bounces.irradiance[1][texel]) / kPi};
    }
  });
  Noise noise;
  for (const Difference& d : differences) {
    noise.ao.add(d.ao * d.ao);
    noise.direct.add(d.direct * d.direct);
    noise.first.add(d.first * d.first);
    noise.ao_direct.add(d.ao * d.direct / 2);
    noise.ao_first.add(d.ao * d.first / 2);
  }
  return noise;
}

// Variance of the direct light of a node.
double node_variance(const Tracer& again, const Visibility& seen) {
  const std::vector<uint32_t> nodes = sample_places(again.patches().count);
  Moments squares;
  Row row;
  TracerCounts counts;
  for (const uint32_t node : nodes) {
    again.trace_patch(node, false, row, counts);
    const double difference = row.direct_over_pi - static_cast<double>(seen.patch_direct()[node]);
    squares.add(difference * difference);
  }
  return squares.mean / 2;
}

// The light of a set of nodes as every other node of each facet tells it: the others get the mean of the two
// beside them.
void tell_by_every_other_node(const PatchSet& patches, std::vector<double>& light) {
  const auto runs = static_cast<uint32_t>(patches.first.size() - 1);
  parallel_for(runs, 256, [&](size_t begin, size_t end) {
    for (size_t r = begin; r < end; ++r) {
      const PatchRun run = patch_run(patches, static_cast<uint32_t>(r));
      const int k = run.subdivision;
      for (uint32_t half = 0; half < 2; ++half)
        for (int b = 0; b <= k; ++b)
          for (int a = 0; a + b <= k; ++a) {
            const int odd_a = a % 2, odd_b = b % 2;
            if (odd_a == 0 && odd_b == 0) continue;
            // Along u, along v, or along the long side.
            const uint32_t node = node_at(k, a, b),
                           one = node_at(k, a - odd_a, b + (odd_a == 1 ? odd_b : -1)),
                           other = node_at(k, a + odd_a, b - (odd_a == 1 ? odd_b : -1));
            for (uint32_t cell = 0; cell < run.cells; ++cell)
              light[run.patch(half, node, cell)] =
                  0.5 * (light[run.patch(half, one, cell)] + light[run.patch(half, other, cell)]);
          }
    }
  });
}

// Means over the texels of E₁ and of the total at albedo ½, with what `change` does to the light of the
// patches before it is gathered.
struct MeanLight {
  double first = 0, half = 0;
};

MeanLight mean_light(const Visibility& seen, const std::function<void(std::vector<double>&)>& change) {
  std::vector<double> light(seen.patch_direct().begin(), seen.patch_direct().end()), next(light.size()),
      sum(light.size()), texels(seen.direct_over_pi.size());
  double power = 0.5;
  MeanLight result;
  for (int bounce = 1; bounce <= kHalfBounces; ++bounce, power /= 2) {
    change(light);
    for (size_t i = 0; i < light.size(); ++i) sum[i] += power * light[i];
    if (bounce == 1) {
      gather(seen.gather, light, texels);
      result.first = mean(std::span<const double>(texels));
    }
    gather(seen.patch_links(), light, next);
    light.swap(next);
  }
  gather(seen.gather, sum, texels);
  result.half = mean(std::span<const double>(texels));
  return result;
}

// Root mean square over the texels of what their bin of the curve shows too much.
double curve_error(const Grid<float>& ao, const Grid<float>& irradiance, double variance, double covariance) {
  std::array<Moments, kBins> bins;
  for (size_t i = 0; i < ao.size(); ++i)
    bins[std::min(kBins - 1, static_cast<size_t>(kBins * std::max(0.0f, ao[i])))].add(
        static_cast<double>(irradiance[i]) / kPi);
  constexpr double kWidth = 1.0 / kBins;
  double sum = 0, texels = 0;
  for (size_t b = 1; b + 1 < kBins; ++b) {
    const Moments &below = bins[b - 1], &here = bins[b], &above = bins[b + 1];
    if (below.count == 0 || here.count == 0 || above.count == 0) continue;
    const auto population = [](const Moments& bin) { return static_cast<double>(bin.count); };
    const double slope = (above.mean - below.mean) / (2 * kWidth);
    const double curvature = (above.mean - 2 * here.mean + below.mean) / (kWidth * kWidth);
    const double log_density_slope =
        (population(above) - population(below)) / (2 * kWidth * population(here));
    const double too_much = (slope * variance - covariance) * log_density_slope + curvature * variance / 2;
    sum += population(here) * too_much * too_much;
    texels += population(here);
  }
  return texels > 0 ? std::sqrt(sum / texels) : 0;
}

}  // namespace

ErrorEstimate estimate_errors(const Tracer& again, const Visibility& seen, const Bounces& bounces) {
  ErrorEstimate errors;
  const Noise noise = trace_again(again, seen, bounces);
  errors.ao_rays = deviation(noise.ao);
  errors.direct_rays = deviation(noise.direct);
  errors.first_rays = deviation(noise.first);
  const double texels = static_cast<double>(seen.direct_over_pi.size());
  errors.mean_direct_rays = errors.direct_rays / std::sqrt(texels);
  // A texel's row and the light it gathers, as if all nodes were seen alike.
  const double blocked = 1 - mean(std::span<const float>(seen.direct_over_pi.values));
  errors.mean_first_rays = std::sqrt(errors.first_rays * errors.first_rays / texels +
                                     blocked * blocked * node_variance(again, seen) / again.patches().count);

  if (again.patches().kind == Patches::kFacets) {
    const MeanLight all = mean_light(seen, [](std::vector<double>&) {});
    const MeanLight coarse = mean_light(
        seen, [&](std::vector<double>& light) { tell_by_every_other_node(again.patches(), light); });
    errors.first_patches = std::abs(coarse.first - all.first) / 3;
    errors.half_patches = std::abs(coarse.half - all.half) / 3;
  }
  errors.total_bounces = std::abs(bounces.mean_residual);
  errors.half_bounces = errors.total_bounces * std::pow(0.5, static_cast<double>(bounces.irradiance.size()));
  errors.far_horizon = static_cast<double>(seen.counts.cut_short) / static_cast<double>(seen.counts.rays);
  errors.curve_direct =
      curve_error(seen.visible_fraction, bounces.irradiance[0], noise.ao.mean / 2, noise.ao_direct.mean);
  errors.curve_first =
      curve_error(seen.visible_fraction, bounces.irradiance[1], noise.ao.mean / 2, noise.ao_first.mean);
  return errors;
}

}  // namespace hemibake
