#include "transport/light_at_albedo.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/progress.h"
#include "transport/links/form_factors.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
// Largest error of a texel, over π.
constexpr double kTolerance = 1e-4;
constexpr uint64_t kMostSteps = 2000, kStepsBetweenTests = 8;

void keep_largest(std::atomic<double>& largest, double value) {
  double known = largest.load();
  while (value > known && !largest.compare_exchange_weak(known, value)) {
  }
}

}  // namespace

LightAtAlbedo::LightAtAlbedo(std::span<const double> direct, double albedo)
    : albedo_(static_cast<float>(albedo)), sum_(direct.begin(), direct.end()) {}

void LightAtAlbedo::add(std::span<const double> bounce) {
  power_ *= albedo_;
  parallel_for(sum_.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sum_[i] += power_ * bounce[i];
  });
}

// Chebyshev's semi-iterative method (Golub and Varga, Numerische Mathematik 3, 1961) for x = direct + ρ W x:
// one more bounce of x, overshot away from the x before, for eigenvalues of ρ W within ±ρ. Noise makes some
// of them complex; where they are far off the axis the residual does not fall, and bounces without
// overshooting go on.
Grid<float> LightAtAlbedo::finish(const LightTransport& transport, const std::vector<double>& last) {
  Progress progress("lighting at the albedo of the bounce map", kMostSteps, "step");
  const FormFactorMatrix& matrix = transport.bounce_matrix();
  const std::vector<float>& sky = transport.patch_direct();
  std::vector<double> before = std::move(sum_), now(last.size()), bounced(last.size());
  multiply(matrix, last, bounced);
  parallel_for(now.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) now[i] = before[i] + power_ * albedo_ * bounced[i];
  });
  double overshoot = 1 / (1 - albedo_ * albedo_ / 2), residual = 1, earlier = HUGE_VAL;
  bool overshoots = true;
  // Rows sum to at most 1, so an error is at most the residual over 1 − ρ.
  for (uint64_t made = 0; made < kMostSteps && residual > kTolerance * (1 - albedo_); ++made) {
    multiply(matrix, now, bounced);
    std::atomic<double> largest = 0;
    parallel_for(now.size(), kGrain, [&](size_t begin, size_t end) {
      double worst = 0;
      for (size_t i = begin; i < end; ++i) {
        const double next = static_cast<double>(sky[i]) + albedo_ * bounced[i];
        worst = std::max(worst, std::abs(next - now[i]));
        before[i] += overshoot * (next - before[i]);
      }
      keep_largest(largest, worst);
    });
    residual = largest;
    now.swap(before);
    if (made % kStepsBetweenTests == 0) {
      overshoots = overshoots && residual < earlier / 2;
      earlier = residual;
    }
    overshoot = overshoots ? 1 / (1 - albedo_ * albedo_ * overshoot / 4) : 1;
    progress.advance(1);
  }
  const Grid<float>& direct = transport.direct_over_pi;
  std::vector<double> gathered(direct.size());
  multiply(transport.final_gather, now, gathered);
  Grid<float> light(direct.width, direct.height);
  for (size_t i = 0; i < light.size(); ++i)
    light[i] = static_cast<float>(static_cast<double>(direct[i]) + albedo_ * gathered[i]);
  return light;
}

}  // namespace hemibake
