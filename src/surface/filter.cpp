#include "surface/filter.h"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr size_t kRowsAtOnce = 8;

struct Tap {
  int dx, dy;
  double weight;  // domain weight × how often the sample is added
};

int times_added(int dx, int dy, FilterSum sum) {
  if (sum == FilterSum::kAll) return 1;
  const int column = wrap_index(dx, 4), row = wrap_index(dy, 4);
  if (row % 2 != 0) return 0;
  return row == 0 && column >= 2 ? 2 : 1;
}

std::vector<Tap> make_taps(const FilterOptions& options) {
  const int reach = static_cast<int>(std::ceil(2 * options.radius));
  const double sigma = options.radius / 3;
  std::vector<Tap> taps;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const double weight = std::exp(-0.5 * (dx * dx + dy * dy) / (sigma * sigma));
      const int times = times_added(dx, dy, options.sum);
      if (times > 0) taps.push_back({dx, dy, times * weight});
    }
  }
  return taps;
}

void check(const FilterOptions& options) {
  if (!(options.radius >= 0 && options.radius <= 16))
    throw InputError(fmt::format("filter radius {} texels, expected 0..16", options.radius));
  if (!(options.tolerance > 0))
    throw InputError(fmt::format("filter tolerance {}, expected above 0", options.tolerance));
}

}  // namespace

FilterOptions mayaux2018_filter() { return {1, 0.2, FilterSum::kMayaux2018}; }

Grid<float> bilateral_filter(const Grid<float>& heights, const FilterOptions& options, Edge edge) {
  check(options);
  if (options.radius == 0) return heights;
  const std::vector<Tap> taps = make_taps(options);
  const int width = heights.width, height = heights.height;
  Grid<float> filtered(width, height);
  const auto filter_texel = [&](int x, int y) {
    const double own = heights(x, y);
    double sum = 0, weight_sum = 0;
    for (const Tap& tap : taps) {
      const int i = wrap_index(x + tap.dx, width), j = wrap_index(y + tap.dy, height);
      if (edge != Edge::kWrap && (i != x + tap.dx || j != y + tap.dy)) continue;
      const double difference = (heights(i, j) - own) / options.tolerance;
      const double weight = tap.weight * std::exp(-0.5 * difference * difference);
      // The texel's own tap has weight 1, so that weight_sum is never 0; differences add up without
      // cancellation.
      sum += weight * (heights(i, j) - own);
      weight_sum += weight;
    }
    return static_cast<float>(own + sum / weight_sum);
  };
  parallel_for(static_cast<size_t>(height), kRowsAtOnce, [&](size_t begin, size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x) filtered(x, y) = filter_texel(x, y);
  });
  return filtered;
}

}  // namespace hemibake
