#include "reference/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "reference/path_tracer.h"
#include "reference/texel_sample.h"

namespace hemibake {
namespace {

// Rays for the AO by which a sampled texel is binned: off by some 0.003.
constexpr int kAoRays = 1024;

// Holds one quantity at every sampled texel, over π.
struct Comparison {
  std::string quantity;
  std::vector<double> bake;
  std::vector<double> reference;
  std::vector<double> reference_variance;
  std::vector<double> cut_off;  // the bake lacks at most this much
};

void check_inputs(const Surface& surface, const JudgedLight& bake, const RefereeCheckOptions& options) {
  if (bake.ao.empty() || bake.irradiance.empty())
    throw InputError("the bake lacks the channels ao or irradiance.00, which the referee compares");
  if (bake.ao.width != surface.width() || bake.ao.height != surface.height())
    throw InputError(fmt::format("bake of {}x{} texels, expected {}x{} as the map", bake.ao.width,
                                 bake.ao.height, surface.width(), surface.height()));
  const auto stored = static_cast<int>(bake.irradiance.size()) - 1;
  if (options.bounces < 0 || options.bounces > stored)
    throw InputError(
        fmt::format("{} bounces to compare, expected 0..{} as the bake holds", options.bounces, stored));
  if (options.texels < 2)
    throw InputError(fmt::format("{} texels to compare, expected 2 or more", options.texels));
  if (!(options.confidence > 0 && options.confidence < 1))
    throw InputError(fmt::format("confidence {}, expected above 0 and below 1", options.confidence));
  if (!(options.albedo >= 0 && options.albedo < 1))
    throw InputError(fmt::format("albedo {}, expected 0 or more and below 1", options.albedo));
  if (options.ao_bins < 1) throw InputError(fmt::format("{} AO bins, expected 1 or more", options.ao_bins));
}

size_t bin_of(double ao, int bins) {
  return static_cast<size_t>(std::clamp(static_cast<int>(ao * bins), 0, bins - 1));
}

// Samples texels in strata by AO, each with a share in proportion to the root of its texel count.
TexelSample sample_by_ao(const Grid<float>& ao, const RefereeCheckOptions& options) {
  std::vector<std::vector<uint32_t>> population(static_cast<size_t>(options.ao_bins));
  for (size_t i = 0; i < ao.size(); ++i) {
    if (std::isnan(ao[i])) continue;  // a hole
    population[bin_of(static_cast<double>(ao[i]), options.ao_bins)].push_back(static_cast<uint32_t>(i));
  }
  double roots = 0;
  for (const auto& texels : population) roots += std::sqrt(static_cast<double>(texels.size()));

  TexelSample sample;
  for (size_t b = 0; b < population.size(); ++b) {
    if (population[b].empty()) continue;
    const double share = std::sqrt(static_cast<double>(population[b].size())) / roots;
    const auto wanted = static_cast<size_t>(std::ceil(share * static_cast<double>(options.texels)));
    const size_t all = options.texels >= ao.size() ? population[b].size() : 0;
    append_sample(sample, sample_texels(population[b], std::max({size_t{2}, wanted, all}), options.seed + b));
  }
  return sample;
}

struct BounceSum {
  double sum = 0;        // Σ_b ρᵇ E_b/π, b = 0 … last
  double under_way = 1;  // 1 − Σ_b E_b/π: after the last bounce at albedo 1
};

// Sums the bounces of a bake without its own code: one by one.
BounceSum sum_bounces(const JudgedLight& bake, uint32_t texel, double albedo) {
  BounceSum result;
  double power = 1;
  for (const Grid<float>& plane : bake.irradiance) {
    const double light = static_cast<double>(plane[texel]) / kPi;
    result.sum += power * light;
    result.under_way -= light;
    power *= albedo;
  }
  result.under_way = std::max(0.0, result.under_way);
  return result;
}

std::vector<Comparison> compare(const JudgedLight& bake, std::span<const uint32_t> texels,
                                const RefereeEstimates& measured, const RefereeCheckOptions& options) {
  const auto bounces_stored = static_cast<int>(bake.irradiance.size()) - 1;
  const double first_cut_off = std::pow(options.albedo, bounces_stored + 1);
  std::vector<Comparison> comparisons(static_cast<size_t>(measured.quantities));
  for (int q = 0; q < measured.quantities; ++q) {
    Comparison& c = comparisons[static_cast<size_t>(q)];
    const bool single = q <= options.bounces, all_bounces = q == options.bounces + 1;
    c.quantity = single        ? fmt::format("E{}", q)
                 : all_bounces ? fmt::format("total at albedo {:g}", options.albedo)
                               : fmt::format("E0 to E{}", bounces_stored);
    for (size_t i = 0; i < texels.size(); ++i) {
      const BounceSum sum = sum_bounces(bake, texels[i], all_bounces ? options.albedo : 1);
      c.bake.push_back(single ? static_cast<double>(bake.irradiance[static_cast<size_t>(q)][texels[i]]) / kPi
                              : sum.sum);
      c.reference.push_back(measured.mean[measured.index(i, q)]);
      c.reference_variance.push_back(measured.variance[measured.index(i, q)]);
      c.cut_off.push_back(all_bounces ? first_cut_off * sum.under_way : 0);
    }
  }
  return comparisons;
}

RefereeVerdict judge(const RefereeRow& row) {
  if (std::abs(row.bias) + row.half_width <= row.tolerance) return RefereeVerdict::kWithin;
  return std::abs(row.bias) - row.half_width > row.tolerance ? RefereeVerdict::kOutside
                                                             : RefereeVerdict::kUndecided;
}

// Compares one quantity over the sampled texels inside.
RefereeRow make_row(const Comparison& comparison, const TexelSample& sample, const std::vector<bool>& inside,
                    double relative_tolerance, double confidence) {
  const size_t count = sample.texels.size();
  std::vector<double> difference(count), squared(count);
  for (size_t i = 0; i < count; ++i) {
    difference[i] = comparison.bake[i] - comparison.reference[i];
    squared[i] = difference[i] * difference[i] - comparison.reference_variance[i];
  }
  const RefereeInterval bias =
      mean_of_domain(sample, inside, difference, comparison.reference_variance, confidence);
  RefereeRow row;
  row.quantity = comparison.quantity;
  row.texels = static_cast<size_t>(std::count(inside.begin(), inside.end(), true));
  row.bake_mean = weighted_mean(sample, inside, comparison.bake);
  row.referee_mean = weighted_mean(sample, inside, comparison.reference);
  row.bias = bias.mean;
  row.half_width = bias.half_width + weighted_mean(sample, inside, comparison.cut_off);
  row.rms_difference = std::sqrt(std::max(0.0, weighted_mean(sample, inside, squared)));
  row.tolerance = relative_tolerance * row.referee_mean;
  row.verdict = judge(row);
  return row;
}

}  // namespace

RefereeCheck check_against_referee(const Surface& surface, const JudgedLight& bake,
                                   const RefereeCheckOptions& options) {
  check_inputs(surface, bake, options);
  const TexelSample sample = sample_by_ao(bake.ao, options);

  RefereeOptions tracing;
  tracing.paths = options.paths;
  tracing.bounces = options.bounces;
  tracing.totals = {{options.albedo, RefereeTotal::kUnlimited},
                    {1, static_cast<int>(bake.irradiance.size()) - 1}};
  tracing.seed = options.seed;
  const RefereeEstimates measured = referee_texels(surface, sample.texels, tracing);
  const std::vector<Comparison> comparisons = compare(bake, sample.texels, measured, options);

  RefereeCheck check;
  check.texels = sample.texels.size();
  check.paths_per_texel = measured.paths();
  check.rays = measured.rays;
  check.truncated_rays = measured.truncated_rays;
  const std::vector<bool> everywhere(sample.texels.size(), true);
  for (const Comparison& comparison : comparisons)
    check.means.push_back(
        make_row(comparison, sample, everywhere, options.mean_tolerance, options.confidence));

  const std::vector<double> ao = referee_visible_fractions(surface, sample.texels, kAoRays, options.seed);
  for (size_t b = 0; b < static_cast<size_t>(options.ao_bins); ++b) {
    std::vector<bool> inside(ao.size());
    for (size_t i = 0; i < ao.size(); ++i) inside[i] = bin_of(ao[i], options.ao_bins) == b;
    if (std::count(inside.begin(), inside.end(), true) < 2) continue;
    for (const Comparison& comparison : comparisons) {
      check.bins.push_back(make_row(comparison, sample, inside, options.bin_tolerance, options.confidence));
      check.bins.back().ao_low = static_cast<double>(b) / options.ao_bins;
      check.bins.back().ao_high = static_cast<double>(b + 1) / options.ao_bins;
    }
  }
  return check;
}

RefereeVerdict worst_verdict(const std::vector<RefereeRow>& rows) {
  RefereeVerdict worst = RefereeVerdict::kWithin;
  for (const RefereeRow& row : rows) {
    if (row.verdict == RefereeVerdict::kOutside) return RefereeVerdict::kOutside;
    if (row.verdict == RefereeVerdict::kUndecided) worst = RefereeVerdict::kUndecided;
  }
  return worst;
}

bool has_passed(const RefereeCheck& check) {
  return worst_verdict(check.means) != RefereeVerdict::kOutside &&
         worst_verdict(check.bins) != RefereeVerdict::kOutside;
}

}  // namespace hemibake
