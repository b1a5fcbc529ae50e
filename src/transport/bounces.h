// Light going round over the links, at albedo 1: E_{b+1} = W E_b between patches, gathered by the texels.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "transport/trace_surface.h"

namespace hemibake {

struct BounceOptions {
  int bounces = 20;                          // stored one by one, 0..
  std::optional<double> converge_tolerance;  // go on until no texel's residual is as large, either way
  int max_bounces = 2000;                    // the end of that in any case, and products of its iteration
};

struct Bounces {
  std::vector<Grid<float>> irradiance;  // E_0 … E_bounces, 0..π
  Grid<float> total;                    // Σ of all bounces made, or converged, 0..π
  // (π − Σ)/π still under way. Converged, it may be negative by less than the tolerance: the iteration comes
  // near the sum from both sides. Texels it did not bring within the tolerance keep the sum of the bounces
  // stored.
  Grid<float> residual;
  int bounces_made = 0;  // stored, and products of the patch links to converge
  double mean_residual = 0, worst_residual = 0;
  uint32_t worst_texel = 0;
  // Only with a tolerance: texels whose residual is not below it, and those among them whose every link leads
  // to themselves, so that no number of bounces would help.
  std::vector<uint32_t> unconverged_texels, enclosed_texels;
};

Bounces bounce_light(const LightTransport& seen, const BounceOptions& options);

// The residual of every texel, their mean and the worst, from the sum of a texel's light over π.
void compute_residual(const std::function<double(size_t)>& total_over_pi, int width, int height,
                      Bounces& result);

}  // namespace hemibake
