#include "transport/bounces.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/statistics.h"
#include "transport/light_at_albedo.h"
#include "transport/solver/orthomin.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
// A test is a final gather, a fifth to half of the work of a product.
constexpr int kBouncesBetweenTests = 10, kStepsBetweenTests = 4;
// Largest |Σ_j w_ij + E₀(i)/π − 1| of rows that conserve energy, whose residual is then known.
constexpr double kConservesEnergy = 1e-6;

std::vector<double> as_double(const std::vector<float>& values) { return {values.begin(), values.end()}; }

void add_to(std::vector<double>& sum, const std::vector<double>& values) {
  parallel_for(sum.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sum[i] += values[i];
  });
}

Grid<float> times_pi(const std::vector<double>& values, int width, int height) {
  Grid<float> grid(width, height);
  for (size_t i = 0; i < grid.size(); ++i) grid[i] = static_cast<float>(kPi * values[i]);
  return grid;
}

// Light of the patches from bounce to bounce, everything over π.
struct PatchBounces {
  const LightTransport& transport;
  std::vector<double> texel_direct;
  std::vector<double> current;  // E_b of the patches
  std::vector<double> sum;      // E_0 + … + E_b of the patches; empty: not needed
  std::vector<double> next;

  PatchBounces(const LightTransport& of, bool with_sum)
      : transport(of),
        texel_direct(as_double(of.direct_over_pi.values)),
        current(as_double(of.patch_direct())),
        next(current.size()) {
    if (with_sum) sum = current;
  }

  void bounce() {
    multiply(transport.bounce_matrix(), current, next);
    current.swap(next);
    if (!sum.empty()) add_to(sum, current);
  }

  // Returns E_0 + … + E_{b+1} of the texels, from the sum to E_b of the patches.
  std::vector<double> texel_total() const { return final_gather(sum); }

  // Returns the light of the texels under the sky and the light of the patches.
  std::vector<double> final_gather(const std::vector<double>& patches) const {
    std::vector<double> total(texel_direct.size());
    multiply(transport.final_gather, patches, total);
    add_to(total, texel_direct);
    return total;
  }
};

double worst_residual(const std::vector<double>& total) {
  return 1 - *std::min_element(total.begin(), total.end());
}

double largest_deviation(const std::vector<double>& total) {
  double worst = 0;
  for (const double sum : total) worst = std::max(worst, std::abs(1 - sum));
  return worst;
}

bool rows_sum_to_one(const FormFactorMatrix& form_factors, const std::vector<float>& direct) {
  const std::vector<double> sums = row_sums(form_factors);
  for (size_t i = 0; i < sums.size(); ++i)
    if (std::abs(sums[i] + static_cast<double>(direct[i]) - 1) > kConservesEnergy) return false;
  return true;
}

// Returns rows whose only entry is themselves with weight 1, ascending.
std::vector<uint32_t> enclosed_rows(const FormFactorMatrix& form_factors) {
  std::vector<uint32_t> rows;
  for (size_t b = 0; b < form_factors.blocks.size(); ++b)
    visit_rows(form_factors, b,
               [&](uint32_t row, std::span<const uint32_t> patches, std::span<const float> weights) {
                 if (patches.size() == 1 && patches[0] == row && weights[0] >= 1) rows.push_back(row);
               });
  return rows;
}

void list_unconverged(const LightTransport& transport, double tolerance, Bounces& result) {
  for (uint32_t texel = 0; texel < result.residual.size(); ++texel)
    if (static_cast<double>(result.residual[texel]) >= tolerance) result.unconverged_texels.push_back(texel);
  if (result.unconverged_texels.empty() || !transport.patch_form_factors.empty()) return;
  std::ranges::set_intersection(enclosed_rows(transport.final_gather), result.unconverged_texels,
                                std::back_inserter(result.enclosed_texels));
}

// Converges bounce by bounce, for rows that do not conserve energy (the march's published weights).
void converge_by_bounces(PatchBounces& patches, const BounceOptions& options, Bounces& result,
                         std::vector<double>& total) {
  Progress progress("converging", static_cast<uint64_t>(options.max_bounces), "bounce");
  while (worst_residual(total) >= *options.converge_tolerance && result.bounces_made < options.max_bounces) {
    const int batch = std::min(kBouncesBetweenTests, options.max_bounces - result.bounces_made);
    // The patches are at bounce `bounces_made`; the final gather adds one more.
    for (int i = 1; i < batch; ++i) patches.bounce();
    total = patches.texel_total();
    patches.bounce();
    result.bounces_made += batch;
    progress.advance(static_cast<uint64_t>(batch));
  }
}

// Converges by the solver until every texel is within the tolerance, either way. Texels that are not, at the
// end of it, keep the sum of the bounces made one by one, which is certainly less than the truth.
void converge(PatchBounces& patches, const BounceOptions& options, Bounces& result,
              std::vector<double>& total) {
  const double tolerance = *options.converge_tolerance;
  if (worst_residual(total) < tolerance || result.bounces_made >= options.max_bounces) return;
  Progress progress("converging", static_cast<uint64_t>(options.max_bounces), "product");
  // The residual of the sum so far is one more bounce.
  std::vector<double> more;
  apply_transport(patches.transport.bounce_matrix(), {}, patches.current, more);
  ++result.bounces_made;
  Orthomin solver(patches.transport.bounce_matrix(), {}, std::move(patches.sum), std::move(more));
  std::vector<double> solved;
  bool goes_on = true;
  while (goes_on) {
    for (int i = 0; i < kStepsBetweenTests && goes_on; ++i) {
      goes_on = result.bounces_made < options.max_bounces && solver.step();
      result.bounces_made += goes_on;
      progress.advance(goes_on);
    }
    // The residual is at most twice the largest error: above that patches are certainly off.
    if (goes_on && solver.largest_residual() > 2 * tolerance) continue;
    solved = patches.final_gather(solver.light());
    goes_on = goes_on && largest_deviation(solved) >= tolerance;
  }
  for (size_t i = 0; i < total.size(); ++i)
    if (std::abs(1 - solved[i]) < tolerance) total[i] = std::max(total[i], solved[i]);
}

}  // namespace

void compute_residual(const std::function<double(size_t)>& total_over_pi, int width, int height,
                      Bounces& result) {
  result.residual = Grid<float>(width, height);
  Moments residuals;
  for (size_t i = 0; i < result.residual.size(); ++i) {
    const double left = 1 - total_over_pi(i);
    result.residual[i] = static_cast<float>(left);
    residuals.add(left);
    if (i == 0 || left > result.worst_residual) {
      result.worst_residual = left;
      result.worst_texel = static_cast<uint32_t>(i);
    }
  }
  result.mean_residual = residuals.mean;
}

Bounces bounce_light(const LightTransport& transport, const BounceOptions& options) {
  const int width = transport.direct_over_pi.width, height = transport.direct_over_pi.height;
  Bounces result;
  PatchBounces patches(transport, options.converge_tolerance.has_value());
  std::optional<LightAtAlbedo> at_albedo;
  if (options.bounce_albedo) at_albedo.emplace(patches.current, *options.bounce_albedo);
  std::vector<double> total = patches.texel_direct, texel_light(total.size());
  result.irradiance.push_back(times_pi(total, width, height));

  Progress progress("bouncing", static_cast<uint64_t>(options.bounces), "bounce");
  const bool goes_on = at_albedo || options.converge_tolerance;
  // Texel bounce b gathers patch bounce b − 1.
  for (int b = 1; b <= options.bounces; ++b) {
    multiply(transport.final_gather, patches.current, texel_light);
    add_to(total, texel_light);
    result.irradiance.push_back(times_pi(texel_light, width, height));
    if (b < options.bounces || goes_on) patches.bounce();
    if (at_albedo) at_albedo->add(patches.current);
    progress.advance(1);
  }
  result.bounces_made = options.bounces;
  if (at_albedo) result.at_albedo = at_albedo->finish(transport, patches.current);

  if (options.converge_tolerance) {
    if (rows_sum_to_one(transport.final_gather, transport.direct_over_pi.values) &&
        rows_sum_to_one(transport.bounce_matrix(), transport.patch_direct())) {
      converge(patches, options, result, total);
    } else {
      converge_by_bounces(patches, options, result, total);
    }
  }

  result.total = times_pi(total, width, height);
  compute_residual([&](size_t i) { return total[i]; }, width, height, result);
  if (options.converge_tolerance) list_unconverged(transport, *options.converge_tolerance, result);
  return result;
}

}  // namespace hemibake
