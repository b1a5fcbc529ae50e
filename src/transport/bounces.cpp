#include "transport/bounces.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/statistics.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
constexpr int kBouncesBetweenTests = 10;  // the test gathers every texel, about half the work of a bounce

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
  const Visibility& seen;
  bool texels_are_patches;
  std::vector<double> texel_direct;
  std::vector<double> current;  // E_b of the patches
  std::vector<double> sum;      // E_0 + … + E_b of the patches
  std::vector<double> next;

  explicit Flow(const Visibility& visibility)
      : seen(visibility),
        texels_are_patches(visibility.patches.empty()),
        texel_direct(as_double(visibility.direct_over_pi.values)),
        current(as_double(visibility.patch_direct())),
        sum(current),
        next(current.size()) {}

  void bounce() {
    gather(seen.patch_links(), current, next);
    current.swap(next);
    add_to(sum, current);
  }

  // E_0 + … + E_{b+1} of the texels, from the patches' sum to E_b.
  std::vector<double> texel_total() const {
    std::vector<double> total(texel_direct.size());
    gather(seen.gather, sum, total);
    add_to(total, texel_direct);
    return total;
  }
};

double worst_residual(const std::vector<double>& total) {
  return 1 - *std::min_element(total.begin(), total.end());
}

bool sees_only_itself(const Links& links, uint32_t row) {
  const LinkBlock& block = links.blocks[row / Links::kRowsPerBlock];
  const uint32_t local = row % Links::kRowsPerBlock;
  const uint32_t begin = block.row_begin[local], end = block.row_begin[local + 1];
  return end == begin + 1 && block.patches[begin] == row && block.weights[begin] >= 1;
}

void name_short_texels(const Visibility& seen, double tolerance, Bounces& result) {
  for (uint32_t texel = 0; texel < result.residual.size(); ++texel) {
    if (static_cast<double>(result.residual[texel]) < tolerance) continue;
    result.texels_short.push_back(texel);
    if (seen.patches.empty() && sees_only_itself(seen.gather, texel)) result.texels_closed.push_back(texel);
  }
}

}  // namespace

Bounces bounce_light(const Visibility& seen, const BounceOptions& options) {
  const int width = seen.direct_over_pi.width, height = seen.direct_over_pi.height;
  Bounces result;
  Flow flow(seen);
  std::vector<double> total = flow.texel_direct, texel_light(total.size());
  result.irradiance.push_back(times_pi(total, width, height));

  Progress progress("bouncing", static_cast<uint64_t>(options.bounces), "bounce");
  // Texel bounce b gathers patch bounce b − 1.
  for (int b = 1; b <= options.bounces; ++b) {
    gather(seen.gather, flow.current, texel_light);
    add_to(total, texel_light);
    result.irradiance.push_back(times_pi(texel_light, width, height));
    flow.bounce();
    progress.advance(1);
  }
  result.bounces_made = options.bounces;

  if (options.converge_tolerance) {
    Progress converging("converging", static_cast<uint64_t>(options.max_bounces), "bounce");
    while (worst_residual(total) >= *options.converge_tolerance &&
           result.bounces_made < options.max_bounces) {
      const int batch = std::min(kBouncesBetweenTests, options.max_bounces - result.bounces_made);
      // After the loop above the patches are at bounce `bounces_made`; the gather adds one more.
      for (int i = 1; i < batch; ++i) flow.bounce();
      total = flow.texel_total();
      flow.bounce();
      result.bounces_made += batch;
      converging.advance(static_cast<uint64_t>(batch));
    }
  }

  result.total = times_pi(total, width, height);
  result.residual = Grid<float>(width, height);
  Moments residuals;
  for (size_t i = 0; i < total.size(); ++i) {
    const double left = 1 - total[i];
    result.residual[i] = static_cast<float>(left);
    residuals.add(left);
    if (i == 0 || left > result.worst_residual) {
      result.worst_residual = left;
      result.worst_texel = static_cast<uint32_t>(i);
    }
  }
  result.mean_residual = residuals.mean;
  if (options.converge_tolerance) name_short_texels(seen, *options.converge_tolerance, result);
  return result;
}

}  // namespace hemibake
