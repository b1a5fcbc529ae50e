// Sums all bounces of light at one albedo, from bounces made at albedo 1.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "transport/trace_surface.h"

namespace hemibake {

class LightAtAlbedo {
 public:
  // direct: E_0 of every patch, any unit. albedo: ρ, inside 0..1.
  LightAtAlbedo(std::span<const double> direct, double albedo);

  // Adds the next bounce of the patches, E_b at albedo 1.
  void add(std::span<const double> bounce);

  // Solves for the light of all bounces from the sum so far, and gathers it at the texels; ends this object.
  // last: the bounce added last, over π. Returns E/π of all bounces at ρ, converged to 10⁻⁴ in every texel.
  Grid<float> finish(const LightTransport& transport, const std::vector<double>& last);

 private:
  double albedo_, power_ = 1;
  std::vector<double> sum_;  // Σ ρᵇ E_b of the patches
};

}  // namespace hemibake
