#include "bake/error_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/statistics.h"
#include "sampling/strata.h"
#include "surface/facets.h"
#include "tracers/ray_options.h"

namespace hemibake {
namespace {

// Groups of neighbouring texels, and nodes, traced again: tracers answer neighbours together.
constexpr uint32_t kGroups = 128, kGroupRows = 16;
constexpr uint64_t kSampleStream = 0xe440;
constexpr size_t kHalfBounces = 8;  // at albedo ½ the rest is below 1/256 of the first
constexpr double kLeft = 2;         // what half as many nodes err by more, over the error
constexpr size_t kBins = 50;

// Two measurements of the same: their difference has twice the variance of one.
struct Noise {
  Moments ao, direct, first, ao_direct, ao_first;
};

double deviation(const Moments& squares) { return std::sqrt(squares.mean / 2); }

// Noise of the direct light of the nodes. What a node sees is so much of its rays: their variance goes like
// E (1 − E), E the direct light over π, and like one over their number, which nodes of one kind share.
struct NodeNoise {
  double mean_variance = 0;
  std::array<double, kNodeKinds> per_binomial{};  // variance over E (1 − E)
};

size_t kind_of(const PatchSet& patches, uint32_t patch) {
  if (patches.kind == PatchKind::kTexels) return 0;
  const FacetNode node = facet_node(patches, patch);
  return node_kind(node.subdivision, node.node);
}

double binomial(double share) { return share * (1 - share); }

// Returns whether a node or texel is no surface.
bool is_open(const Tracer& tracer, uint32_t patch) {
  const Surface& surface = tracer.surface();
  if (surface.holes.empty()) return false;
  if (tracer.patch_set().kind == PatchKind::kTexels) return surface.is_hole(patch);
  return facet_is_open(surface, facet_node(tracer.patch_set(), patch).facet);
}

// Calls act(index, row) for a sample of receivers. trace(first, rows, counts): as Tracer::trace_texels.
template <class Trace, class Act>
void for_each_sampled(uint32_t count, const Trace& trace, const Act& act) {
  std::vector<Row> rows(kGroupRows);
  TracerCounts counts;
  for (const uint32_t group :
       stratified_sample((count + kGroupRows - 1) / kGroupRows, kGroups, kSampleStream)) {
    const uint32_t first = group * kGroupRows;
    const std::span<Row> of_group(rows.data(), std::min(kGroupRows, count - first));
    trace(first, of_group, counts);
    for (uint32_t i = 0; i < of_group.size(); ++i) act(first + i, of_group[i]);
  }
}

NodeNoise node_noise(const Tracer& again, const LightTransport& seen) {
  Moments all;
  std::array<Moments, kNodeKinds> squares, binomials;
  const auto trace = [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
    again.trace_patches(first, false, rows, counts);
  };
  for_each_sampled(again.patch_set().count, trace, [&](uint32_t node, const Row& row) {
    if (is_open(again, node)) return;
    const double direct = static_cast<double>(seen.patch_direct()[node]);
    const double variance = (row.direct_over_pi - direct) * (row.direct_over_pi - direct) / 2;
    const size_t kind = kind_of(again.patch_set(), node);
    all.add(variance);
    squares[kind].add(variance);
    binomials[kind].add(binomial(direct));
  });
  NodeNoise noise;
  noise.mean_variance = all.mean;
  for (size_t kind = 0; kind < kNodeKinds; ++kind)
    if (binomials[kind].mean > 0) noise.per_binomial[kind] = squares[kind].mean / binomials[kind].mean;
  return noise;
}

// The sampled texels again, with the same light of the patches; its noise comes on top.
Noise trace_again(const Tracer& again, const LightTransport& seen, const Bounces& bounces,
                  const NodeNoise& nodes) {
  Noise noise;
  const auto trace = [&](uint32_t first, std::span<Row> rows, TracerCounts& counts) {
    again.trace_texels(first, true, rows, counts);
  };
  for_each_sampled(again.surface().texel_count(), trace, [&](uint32_t texel, const Row& row) {
    if (again.surface().is_hole(texel)) return;
    double light = 0, light_variance = 0;
    for (const FormFactor& link : row.links) {
      const double weight = static_cast<double>(link.weight);
      const double direct = static_cast<double>(seen.patch_direct()[link.patch]);
      light += weight * direct;
      light_variance +=
          weight * weight * binomial(direct) * nodes.per_binomial[kind_of(again.patch_set(), link.patch)];
    }
    const double ao = row.visible_fraction - static_cast<double>(seen.visible_fraction[texel]);
    const double direct = row.direct_over_pi - static_cast<double>(seen.direct_over_pi[texel]);
    const double first = light - static_cast<double>(bounces.irradiance[1][texel]) / kPi;
    noise.ao.add(ao * ao);
    noise.direct.add(direct * direct);
    noise.first.add(first * first + 2 * light_variance);
    noise.ao_direct.add(ao * direct / 2);
    noise.ao_first.add(ao * first / 2);
  });
  return noise;
}

// The light of a set of nodes as every other node of each facet tells it: the others get the mean of the two
// beside them.
void richardson_by_every_other_node(const PatchSet& patches, std::vector<double>& light) {
  parallel_for(size_t{2} * patches.columns * patches.cell_rows, 4096, [&](size_t begin, size_t end) {
    for (size_t f = begin; f < end; ++f) {
      const auto facet = static_cast<uint32_t>(f);
      const int k = subdivision(patches, facet);
      const auto light_at = [&](int a, int b) -> double& {
        return light[patch_at(patches, facet, node_at(k, a, b))];
      };
      for (int b = 0; b <= k; ++b)
        for (int a = 0; a + b <= k; ++a) {
          const int odd_a = a % 2, odd_b = b % 2;
          if (odd_a == 0 && odd_b == 0) continue;
          // Along u, along v, or along the long side.
          const int step_b = odd_a == 1 ? odd_b : -1;
          light_at(a, b) = 0.5 * (light_at(a - odd_a, b + step_b) + light_at(a + odd_a, b - step_b));
        }
    }
  });
}

// Means over the texels of E₁ and of the first bounces at albedo ½ added up.
struct MeanLight {
  double first = 0, half = 0;
};

MeanLight mean_light(const Bounces& bounces) {
  MeanLight result;
  double power = 0.5;
  for (size_t bounce = 1; bounce < bounces.irradiance.size() && bounce <= kHalfBounces;
       ++bounce, power /= 2) {
    const double light = mean(std::span<const float>(bounces.irradiance[bounce].values)) / kPi;
    if (bounce == 1) result.first = light;
    result.half += power * light;
  }
  return result;
}

// Bounces `bounces` times with light interpolated between every other node.
MeanLight mean_coarse_light(const PatchSet& patches, const LightTransport& seen, size_t bounces) {
  std::vector<double> light(seen.patch_direct().begin(), seen.patch_direct().end()), next(light.size()),
      sum(light.size()), texels(seen.direct_over_pi.size());
  double power = 0.5;
  MeanLight result;
  for (size_t bounce = 1; bounce <= bounces; ++bounce, power /= 2) {
    richardson_by_every_other_node(patches, light);
    for (size_t i = 0; i < light.size(); ++i) sum[i] += power * light[i];
    if (bounce == 1) {
      multiply(seen.final_gather, light, texels);
      result.first = mean(std::span<const double>(texels));
    }
    if (bounce == bounces) break;
    multiply(seen.bounce_matrix(), light, next);
    light.swap(next);
  }
  multiply(seen.final_gather, sum, texels);
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

ErrorEstimate estimate_errors(const Tracer& again, const LightTransport& seen, const Bounces& bounces) {
  ErrorEstimate errors;
  const NodeNoise nodes = node_noise(again, seen);
  const Noise noise = trace_again(again, seen, bounces, nodes);
  errors.ao_rays = deviation(noise.ao);
  errors.direct_rays = deviation(noise.direct);
  errors.first_rays = deviation(noise.first);
  const double texels = static_cast<double>(seen.direct_over_pi.size());
  errors.mean_direct_rays = errors.direct_rays / std::sqrt(texels);
  // The texels' rows and the light they gather, as if all nodes were seen alike.
  const double blocked = 1 - mean(std::span<const float>(seen.direct_over_pi.values));
  errors.mean_first_rays = std::sqrt(errors.first_rays * errors.first_rays / texels +
                                     blocked * blocked * nodes.mean_variance / again.patch_set().count);

  if (again.patch_set().kind == PatchKind::kFacets) {
    const MeanLight all = mean_light(bounces);
    const MeanLight coarse =
        mean_coarse_light(again.patch_set(), seen, std::min(kHalfBounces, bounces.irradiance.size() - 1));
    errors.first_patches = std::abs(coarse.first - all.first) / kLeft;
    errors.half_patches = std::abs(coarse.half - all.half) / kLeft;
  }
  errors.total_bounces = std::abs(bounces.mean_residual);
  errors.half_bounces = errors.total_bounces * std::pow(0.5, static_cast<double>(bounces.irradiance.size()));
  errors.far_horizon = static_cast<double>(seen.counts.truncated) / static_cast<double>(seen.counts.rays);
  errors.curve_direct =
      curve_error(seen.visible_fraction, bounces.irradiance[0], noise.ao.mean / 2, noise.ao_direct.mean);
  errors.curve_first =
      curve_error(seen.visible_fraction, bounces.irradiance[1], noise.ao.mean / 2, noise.ao_first.mean);
  return errors;
}

}  // namespace hemibake
