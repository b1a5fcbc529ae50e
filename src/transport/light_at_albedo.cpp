#include "transport/light_at_albedo.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "core/progress.h"
#include "transport/links/form_factors.h"
#include "transport/series.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
// Largest step of the extrapolated sum of a patch that ends it, over π. The steps shrink at least by ρ each.
constexpr double kStandsStill = 1e-5;
constexpr uint64_t kMaxBounces = 2000;

void keep_largest(std::atomic<double>& largest, double value) {
  double known = largest.load();
  while (value > known && !largest.compare_exchange_weak(known, value)) {
  }
}

}  // namespace

LightAtAlbedo::LightAtAlbedo(std::span<const double> direct, double albedo)
    : albedo_(albedo), sum_(direct.begin(), direct.end()) {}

void LightAtAlbedo::add(std::span<const double> bounce) {
  power_ *= albedo_;
  parallel_for(sum_.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sum_[i] += power_ * bounce[i];
  });
}

Grid<float> LightAtAlbedo::finish(const LightTransport& transport, std::vector<double> last) {
  Progress progress("lighting at the albedo of the bounce map", kMaxBounces, "bounce");
  std::vector<double> next(last.size()), extrapolated(last.size());
  double step = 1;
  for (uint64_t made = 0; step > kStandsStill && made < kMaxBounces; ++made) {
    multiply(transport.bounce_matrix(), last, next);
    add(next);
    std::atomic<double> largest = 0;
    parallel_for(sum_.size(), kGrain, [&](size_t begin, size_t end) {
      double worst = 0;
      for (size_t i = begin; i < end; ++i) {
        const double now = power_ * next[i], before = power_ / albedo_ * last[i];
        const double value = sum_[i] + series_tail(before, now, albedo_);
        worst = std::max(worst, std::abs(value - extrapolated[i]));
        extrapolated[i] = value;
      }
      keep_largest(largest, worst);
    });
    step = largest;
    last.swap(next);
    progress.advance(1);
  }
  const Grid<float>& direct = transport.direct_over_pi;
  std::vector<double> gathered(direct.size());
  multiply(transport.final_gather, extrapolated, gathered);
  Grid<float> light(direct.width, direct.height);
  for (size_t i = 0; i < light.size(); ++i)
    light[i] = static_cast<float>(static_cast<double>(direct[i]) + albedo_ * gathered[i]);
  return light;
}

}  // namespace hemibake
