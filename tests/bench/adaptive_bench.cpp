// Would rays by texel pay? If the noise of every texel were known beforehand, rays could go where it is
// largest. The squared error of a texel with n rays is c n⁻ᵖ; the mean of c n⁻ᵖ at a given number of rays in
// all is least with n in proportion to c^(1/(p+1)). Printed: how many rays fewer that takes than the same for
// all, at equal rms error over the map, with c from the texel's α (averages over many seeds) and from a pilot
// (the variance of the 25 texels around, of four seeds, which cost nothing here).
//
//   hemibake_bench_adaptive [SIDE]     96
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "core/statistics.h"
#include "support/maps.h"
#include "tracers/embree/embree.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr int kSeeds = 12, kPilotSeeds = 4, kFewRays = 32, kManyRays = 128;
constexpr size_t kBins = 40;

using Values = std::vector<double>;

struct Measured {
  Values mean, variance, pilot_variance, other_variance;  // per texel: of all seeds, the first, the rest
};

// α and E₀/π.
std::array<Measured, 2> measure(const Surface& surface, int rays) {
  const size_t texels = surface.texel_count();
  std::array<std::vector<Moments>, 2> all, pilot, rest;
  for (auto* moments : {&all, &pilot, &rest})
    for (auto& quantity : *moments) quantity.resize(texels);
  for (int seed = 0; seed < kSeeds; ++seed) {
    RayOptions options;
    options.rays = rays;
    options.seed = static_cast<uint64_t>(seed);
    const LightTransport seen = trace_surface(*make_embree_tracer(surface, options), KeptLinks::kNone);
    for (size_t i = 0; i < texels; ++i)
      for (size_t q = 0; q < 2; ++q) {
        const double value = static_cast<double>(q == 0 ? seen.visible_fraction[i] : seen.direct_over_pi[i]);
        all[q][i].add(value);
        (seed < kPilotSeeds ? pilot : rest)[q][i].add(value);
      }
  }
  std::array<Measured, 2> result;
  for (size_t q = 0; q < 2; ++q)
    for (size_t i = 0; i < texels; ++i) {
      const auto variance = [](const Moments& m) { return m.stddev() * m.stddev(); };
      result[q].mean.push_back(all[q][i].mean);
      result[q].variance.push_back(variance(all[q][i]));
      result[q].pilot_variance.push_back(variance(pilot[q][i]));
      result[q].other_variance.push_back(variance(rest[q][i]));
    }
  return result;
}

Values by_alpha(const Values& alpha, const Values& variance) {
  std::array<Moments, kBins> bins;
  const auto bin = [](double a) { return std::min(kBins - 1, static_cast<size_t>(a * kBins)); };
  for (size_t i = 0; i < alpha.size(); ++i) bins[bin(alpha[i])].add(variance[i]);
  Values known;
  for (const double a : alpha) known.push_back(bins[bin(a)].mean);
  return known;
}

Values around(const Surface& surface, const Values& variance) {
  Values smooth(variance.size());
  for (int y = 0; y < surface.height(); ++y)
    for (int x = 0; x < surface.width(); ++x) {
      Moments box;
      for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i)
          box.add(variance[surface.heights_m.index(wrap_index(x + i, surface.width()),
                                                   wrap_index(y + j, surface.height()))]);
      smooth[surface.heights_m.index(x, y)] = box.mean;
    }
  return smooth;
}

// Share of the rays saved at equal rms error by rays after `known`, where `variance` is the truth.
double saved(const Values& known, const Values& variance, double p) {
  const double least = 0.05 * mean(std::span<const double>(known));
  Values rays;
  for (const double c : known) rays.push_back(std::pow(std::max(c, least), 1 / (p + 1)));
  const double mean_rays = mean(std::span<const double>(rays));
  Values squared;
  for (size_t i = 0; i < rays.size(); ++i) squared.push_back(variance[i] * std::pow(rays[i] / mean_rays, -p));
  return 1 -
         std::pow(mean(std::span<const double>(squared)) / mean(std::span<const double>(variance)), 1 / p);
}

void study(const char* name, const Surface& surface) {
  const auto few = measure(surface, kFewRays), many = measure(surface, kManyRays);
  for (size_t q = 0; q < 2; ++q) {
    const double p = std::log(mean(std::span<const double>(few[q].variance)) /
                              mean(std::span<const double>(many[q].variance))) /
                     std::log(static_cast<double>(kManyRays) / kFewRays);
    fmt::print(
        "{:<14} {:<5} squared error like rays^-{:.2f}; rays saved by alpha {:4.1f} %, by a free pilot "
        "{:4.1f} %\n",
        name, q == 0 ? "alpha" : "E0/pi", p,
        100 * saved(by_alpha(many[0].mean, few[q].variance), few[q].variance, p),
        100 * saved(around(surface, many[q].pilot_variance), many[q].other_variance, p));
  }
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  using namespace hemibake;
  const int side = argc > 1 ? std::atoi(argv[1]) : 96;
  study("bricks 0.1", synthetic_surface(SyntheticKind::kBricks, side, side, 0.1));
  study("shapes 0.45", synthetic_surface(SyntheticKind::kShapes, side, side, 0.45));
  study("concrete 0.05", synthetic_surface(SyntheticKind::kConcrete, side, side, 0.05));
  study("noise 0.1", synthetic_surface(SyntheticKind::kNoise, side, side, 0.1));
}
