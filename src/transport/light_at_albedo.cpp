#include "transport/light_at_albedo.h"

#include <utility>

#include "core/parallel.h"
#include "core/progress.h"
#include "transport/links/form_factors.h"
#include "transport/solver/orthomin.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 16384;
// Largest error of a texel, over π.
constexpr double kTolerance = 1e-4;
constexpr uint64_t kMostSteps = 2000;

}  // namespace

LightAtAlbedo::LightAtAlbedo(std::span<const double> direct, double albedo)
    : albedo_(static_cast<float>(albedo)), sum_(direct.begin(), direct.end()) {}

void LightAtAlbedo::add(std::span<const double> bounce) {
  power_ *= albedo_;
  parallel_for(sum_.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) sum_[i] += power_ * bounce[i];
  });
}

Grid<float> LightAtAlbedo::finish(const LightTransport& transport, const std::vector<double>& last) {
  Progress progress("lighting at the albedo of the bounce map", kMostSteps, "step");
  // What one more bounce adds is the residual of the sum.
  std::vector<double> more(last.size());
  multiply(transport.bounce_matrix(), last, more);
  for (double& light : more) light *= power_ * albedo_;
  const std::vector<float> everywhere(last.size(), static_cast<float>(albedo_));
  Orthomin solver(transport.bounce_matrix(), everywhere, std::move(sum_), std::move(more));
  // Rows sum to at most 1, so an error is at most the residual over 1 − ρ.
  for (uint64_t made = 0; made < kMostSteps && solver.largest_residual() > kTolerance * (1 - albedo_);
       ++made) {
    if (!solver.step()) break;
    progress.advance(1);
  }
  const Grid<float>& direct = transport.direct_over_pi;
  std::vector<double> gathered(direct.size());
  multiply(transport.final_gather, solver.light(), gathered);
  Grid<float> light(direct.width, direct.height);
  for (size_t i = 0; i < light.size(); ++i)
    light[i] = static_cast<float>(static_cast<double>(direct[i]) + albedo_ * gathered[i]);
  return light;
}

}  // namespace hemibake
