#include "bake/energy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"
#include "core/statistics.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

// Sums of floats: each of up to 1000 stored bounces is rounded to 3·10⁻⁸ of itself, their sum to less than
// this.
constexpr double kRounding = 2e-6;
constexpr double kRowSumTolerance = 1e-5;
constexpr double kForInformation = std::numeric_limits<double>::infinity();

double worst_row(const FormFactorMatrix& links, const std::vector<float>& direct) {
  const std::vector<double> sums = row_sums(links);
  double worst = 0;
  for (size_t i = 0; i < sums.size(); ++i)
    worst = std::max(worst, std::abs(sums[i] + static_cast<double>(direct[i]) - 1));
  return worst;
}

// The value furthest from what is expected, and the texel it is at.
struct Extreme {
  double value = 0;
  double distance = -1;
  size_t texel = 0;

  void offer(double candidate, double expected, size_t index) {
    const double away = std::isnan(candidate) ? kForInformation : std::abs(candidate - expected);
    if (away > distance) *this = {candidate, away, index};
  }
};

std::string at_texel(const Bake& bake, size_t texel) {
  const size_t width = static_cast<size_t>(bake.width);
  return fmt::format("texel {},{}", texel % width, texel / width);
}

// Σ_b E_b/π + residual: what came and what is still under way.
void check_energy(const Bake& bake, const BakeCheckOptions& options, Checks& checks) {
  Extreme balance, total, excess;
  std::vector<Moments> bin_totals(static_cast<size_t>(options.bins));
  for (size_t i = 0; i < bake.total.size(); ++i) {
    if (is_hole(bake, i)) continue;
    const double sum = static_cast<double>(bake.total[i]) / kPi;
    balance.offer(sum + static_cast<double>(bake.residual[i]), 1, i);
    total.offer(sum, 1, i);
    double stored = 0;
    for (const auto& plane : bake.irradiance) stored += static_cast<double>(plane[i]) / kPi;
    excess.offer(std::max(0.0, stored - sum), 0, i);
    if (!bake.visible_fraction.empty()) {
      const int bin =
          std::clamp(static_cast<int>(options.bins * bake.visible_fraction[i]), 0, options.bins - 1);
      bin_totals[static_cast<size_t>(bin)].add(sum);
    }
  }
  Extreme bin;
  for (size_t b = 0; b < bin_totals.size(); ++b)
    if (bin_totals[b].count > 0) bin.offer(bin_totals[b].mean, 1, b);

  const double judged = options.energy_tolerance.value_or(kForInformation);
  checks.push_back(
      {"energy sum/pi + residual, worst texel", balance.value, 1, kRounding, at_texel(bake, balance.texel)});
  checks.push_back({"stored bounces above the sum, worst texel", excess.value, 0, kRounding,
                    at_texel(bake, excess.texel)});
  checks.push_back({"energy sum/pi, worst texel", total.value, 1, judged, at_texel(bake, total.texel)});
  if (bin.distance >= 0)
    checks.push_back({"energy sum/pi, worst AO bin", bin.value, 1, judged, fmt::format("bin {}", bin.texel)});
}

// More than π comes to no texel, and less than nothing neither.
void check_ranges(const Bake& bake, Checks& checks) {
  Extreme outside;
  for (const auto& plane : bake.irradiance)
    for (size_t i = 0; i < plane.size(); ++i) {
      if (is_hole(bake, i)) continue;
      const double e = static_cast<double>(plane[i]) / kPi;
      outside.offer(e < 0 ? -e : std::max(0.0, e - 1), 0, i);
    }
  if (outside.distance >= 0)
    checks.push_back(
        {"irradiance/pi outside 0..1, worst", outside.value, 0, kRounding, at_texel(bake, outside.texel)});
}

// The cosine-weighted fraction E₀/π lies between what the same α gives when the horizon is darkest or
// brightest: visible directions all at the rim, or all about the normal.
void check_bounds(const Bake& bake, const BakeCheckOptions& options, Checks& checks) {
  Extreme below, above;
  for (size_t i = 0; i < bake.visible_fraction.size(); ++i) {
    if (is_hole(bake, i)) continue;
    const double alpha = static_cast<double>(bake.visible_fraction[i]);
    const double cosine = static_cast<double>(bake.irradiance.front()[i]) / kPi;
    below.offer(std::max(0.0, alpha * alpha - cosine), 0, i);
    above.offer(std::max(0.0, cosine - alpha * (2 - alpha)), 0, i);
  }
  checks.push_back({"E0/pi below ao^2, worst texel", below.value, 0, options.bounds_tolerance,
                    at_texel(bake, below.texel)});
  checks.push_back({"E0/pi above ao(2-ao), worst texel", above.value, 0, options.bounds_tolerance,
                    at_texel(bake, above.texel)});
}

}  // namespace

LinkEnergy measure_link_energy(const Surface& surface, const PatchSet& patches, const LightTransport& seen) {
  LinkEnergy energy;
  energy.row_sum_error = worst_row(seen.final_gather, seen.direct_over_pi.values);
  if (seen.patch_form_factors.empty()) return energy;
  energy.row_sum_error =
      std::max(energy.row_sum_error, worst_row(seen.patch_form_factors, seen.patch_direct_over_pi));
  if (surface.edge != Edge::kWrap || !surface.holes.empty()) return energy;

  const double rays =
      static_cast<double>(seen.counts.rays) / (seen.final_gather.rows + seen.patch_form_factors.rows);
  const double opening = 0.5 * facet_count(surface);  // texels²
  double light = 0, variance = 0;
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
    const int k = subdivision(patches, facet);
    const double facet_area = 0.5 * facet_area_ratio(surface, facet);
    for (uint32_t node = 0; node < node_count(k); ++node) {
      const double area = facet_area * node_area_share(k, node);
      const double seen_sky = static_cast<double>(seen.patch_direct_over_pi[patch_at(patches, facet, node)]);
      light += area * seen_sky;
      variance += area * area * seen_sky * (1 - seen_sky) / rays;
    }
  }
  energy.light_over_opening = light / opening;
  energy.light_over_opening_stderr = std::sqrt(variance) / opening;
  return energy;
}

Checks check_bake(const Bake& bake, const BakeCheckOptions& options) {
  Checks checks;
  if (!bake.total.empty() && !bake.residual.empty()) check_energy(bake, options, checks);
  check_ranges(bake, checks);
  if (!bake.visible_fraction.empty() && !bake.irradiance.empty()) check_bounds(bake, options, checks);
  if (options.link_energy) {
    checks.push_back({"link rows: sum of weights + E0/pi, largest error", options.link_energy->row_sum_error,
                      0, kRowSumTolerance, ""});
    if (options.link_energy->light_over_opening) {
      // Four standard errors, and a thousandth for rays that meet an edge.
      const double error = options.link_energy->light_over_opening_stderr;
      checks.push_back({"facet light over opening, area mean", *options.link_energy->light_over_opening, 1,
                        4 * error + 1e-3, fmt::format("4 x {:.1e} + 0.001", error)});
    }
  }
  if (options.tiled_with_own_normals && !bake.irradiance.empty() && !bake.normals.empty()) {
    double light = 0;
    size_t texels = 0;
    for (size_t i = 0; i < bake.normals.size(); ++i) {
      if (is_hole(bake, i)) continue;
      ++texels;
      light += static_cast<double>(bake.irradiance.front()[i]) / kPi / static_cast<double>(bake.normals[i].z);
    }
    checks.push_back({"texel light over opening (texel quadrature)", light / static_cast<double>(texels), 1,
                      kForInformation, "shrinks with resolution"});
  }
  return checks;
}

}  // namespace hemibake
