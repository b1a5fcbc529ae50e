#include "transport/bounces.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/statistics.h"
#include "transport/solver/orthomin.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
// A test gathers every texel, a fifth to half of the work of a product.
constexpr int kBouncesBetweenTests = 10, kStepsBetweenTests = 4;
// Largest |Σ_j w_ij + E₀(i)/π − 1| of rows that keep the energy: what is still under way is then known.
constexpr double kKeepsEnergy = 1e-6;

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

// Light under way: everything over π.
struct Flow {
  const LightTransport& seen;
  bool texels_are_patches;
  std::vector<double> texel_direct;
  std::vector<double> current;  // E_b of the patches
  std::vector<double> sum;      // E_0 + … + E_b of the patches
  std::vector<double> next;

  explicit Flow(const LightTransport& visibility)
      : seen(visibility),
        texels_are_patches(visibility.patch_form_factors.empty()),
        texel_direct(as_double(visibility.direct_over_pi.values)),
        current(as_double(visibility.patch_direct())),
        sum(current),
        next(current.size()) {}

  void bounce() {
    multiply(seen.bounce_matrix(), current, next);
    current.swap(next);
    add_to(sum, current);
  }

  // E_0 + … + E_{b+1} of the texels, from the patches' sum to E_b.
  std::vector<double> texel_total() const { return gathered(sum); }

  // Texels under the sky and the light of the patches.
  std::vector<double> gathered(const std::vector<double>& patches) const {
    std::vector<double> total(texel_direct.size());
    multiply(seen.final_gather, patches, total);
    add_to(total, texel_direct);
    return total;
  }
};

double worst_residual(const std::vector<double>& total) {
  return 1 - *std::min_element(total.begin(), total.end());
}

double worst_either_way(const std::vector<double>& total) {
  double worst = 0;
  for (const double sum : total) worst = std::max(worst, std::abs(1 - sum));
  return worst;
}

bool rows_sum_to_one(const FormFactorMatrix& links, const std::vector<float>& direct) {
  const std::vector<double> sums = row_sums(links);
  for (size_t i = 0; i < sums.size(); ++i)
    if (std::abs(sums[i] + static_cast<double>(direct[i]) - 1) > kKeepsEnergy) return false;
  return true;
}

// Rows whose one link leads to themselves and loses nothing, ascending.
std::vector<uint32_t> rows_that_see_only_themselves(const FormFactorMatrix& links) {
  std::vector<uint32_t> closed;
  for (size_t b = 0; b < links.blocks.size(); ++b)
    visit_rows(links, b,
               [&](uint32_t row, std::span<const uint32_t> patches, std::span<const float> weights) {
                 if (patches.size() == 1 && patches[0] == row && weights[0] >= 1) closed.push_back(row);
               });
  return closed;
}

void name_short_texels(const LightTransport& seen, double tolerance, Bounces& result) {
  for (uint32_t texel = 0; texel < result.residual.size(); ++texel)
    if (static_cast<double>(result.residual[texel]) >= tolerance) result.unconverged_texels.push_back(texel);
  if (result.unconverged_texels.empty() || !seen.patch_form_factors.empty()) return;
  std::ranges::set_intersection(rows_that_see_only_themselves(seen.final_gather), result.unconverged_texels,
                                std::back_inserter(result.enclosed_texels));
}

// Bounce after bounce, for rows that do not keep the energy (the march's published weights).
void converge_by_bounces(Flow& flow, const BounceOptions& options, Bounces& result,
                         std::vector<double>& total) {
  Progress progress("converging", static_cast<uint64_t>(options.max_bounces), "bounce");
  while (worst_residual(total) >= *options.converge_tolerance && result.bounces_made < options.max_bounces) {
    const int batch = std::min(kBouncesBetweenTests, options.max_bounces - result.bounces_made);
    // The patches are at bounce `bounces_made`; the gather adds one more.
    for (int i = 1; i < batch; ++i) flow.bounce();
    total = flow.texel_total();
    flow.bounce();
    result.bounces_made += batch;
    progress.advance(static_cast<uint64_t>(batch));
  }
}

// The accelerated iteration, until no texel is off by the tolerance either way. Where one is still, at the
// end of it, the bounces made one by one count, which are less than the truth for certain.
void converge(Flow& flow, const BounceOptions& options, Bounces& result, std::vector<double>& total) {
  const double tolerance = *options.converge_tolerance;
  if (worst_residual(total) < tolerance || result.bounces_made >= options.max_bounces) return;
  Progress progress("converging", static_cast<uint64_t>(options.max_bounces), "product");
  // One bounce more is what the sum so far is short of, as the solver counts.
  std::vector<double> more;
  apply_transport(flow.seen.bounce_matrix(), {}, flow.current, more);
  ++result.bounces_made;
  Orthomin solver(flow.seen.bounce_matrix(), {}, std::move(flow.sum), std::move(more));
  std::vector<double> solved;
  bool goes_on = true;
  while (goes_on) {
    for (int i = 0; i < kStepsBetweenTests && goes_on; ++i) {
      goes_on = result.bounces_made < options.max_bounces && solver.step();
      result.bounces_made += goes_on;
      progress.advance(goes_on);
    }
    // A residual is at most twice the largest error: before that patches are off for certain.
    if (goes_on && solver.largest_residual() > 2 * tolerance) continue;
    solved = flow.gathered(solver.light());
    goes_on = goes_on && worst_either_way(solved) >= tolerance;
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

Bounces bounce_light(const LightTransport& seen, const BounceOptions& options) {
  const int width = seen.direct_over_pi.width, height = seen.direct_over_pi.height;
  Bounces result;
  Flow flow(seen);
  std::vector<double> total = flow.texel_direct, texel_light(total.size());
  result.irradiance.push_back(times_pi(total, width, height));

  Progress progress("bouncing", static_cast<uint64_t>(options.bounces), "bounce");
  // Texel bounce b gathers patch bounce b − 1.
  for (int b = 1; b <= options.bounces; ++b) {
    multiply(seen.final_gather, flow.current, texel_light);
    add_to(total, texel_light);
    result.irradiance.push_back(times_pi(texel_light, width, height));
    flow.bounce();
    progress.advance(1);
  }
  result.bounces_made = options.bounces;

  if (options.converge_tolerance) {
    if (rows_sum_to_one(seen.final_gather, seen.direct_over_pi.values) &&
        rows_sum_to_one(seen.bounce_matrix(), seen.patch_direct())) {
      converge(flow, options, result, total);
    } else {
      converge_by_bounces(flow, options, result, total);
    }
  }

  result.total = times_pi(total, width, height);
  compute_residual([&](size_t i) { return total[i]; }, width, height, result);
  if (options.converge_tolerance) name_short_texels(seen, *options.converge_tolerance, result);
  return result;
}

}  // namespace hemibake
