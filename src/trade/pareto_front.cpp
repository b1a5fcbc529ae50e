#include "trade/pareto_front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"

namespace hemibake {

std::vector<size_t> pareto_front(std::span<const CostAndError> runs) {
  std::vector<size_t> order(runs.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::sort(order, [&](size_t a, size_t b) {
    if (runs[a].cpu_seconds != runs[b].cpu_seconds) return runs[a].cpu_seconds < runs[b].cpu_seconds;
    if (runs[a].error != runs[b].error) return runs[a].error < runs[b].error;
    return a < b;
  });
  std::vector<size_t> front;
  double best = std::numeric_limits<double>::infinity();
  for (const size_t i : order) {
    if (!(runs[i].error < best)) continue;
    best = runs[i].error;
    front.push_back(i);
  }
  return front;
}

PowerLaw fit_power_law(std::span<const double> x, std::span<const double> y) {
  expect_equal(x.size(), y.size(), "points of a power law");
  std::vector<double> u, v;
  for (size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0 && y[i] > 0)) continue;
    u.push_back(std::log(x[i]));
    v.push_back(std::log(y[i]));
  }
  PowerLaw law;
  law.points = u.size();
  if (law.points < 2) return law;
  const double n = static_cast<double>(law.points);
  const double mean_u = std::accumulate(u.begin(), u.end(), 0.0) / n;
  const double mean_v = std::accumulate(v.begin(), v.end(), 0.0) / n;
  double uu = 0, uv = 0, vv = 0;
  for (size_t i = 0; i < u.size(); ++i) {
    uu += (u[i] - mean_u) * (u[i] - mean_u);
    uv += (u[i] - mean_u) * (v[i] - mean_v);
    vv += (v[i] - mean_v) * (v[i] - mean_v);
  }
  if (uu == 0) return {.points = 0};
  law.slope = uv / uu;
  if (law.points > 2) law.slope_error = std::sqrt(std::max(0.0, vv - law.slope * uv) / (n - 2) / uu);
  return law;
}

}  // namespace hemibake
