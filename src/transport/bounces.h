// Light going round over the links, at albedo 1: E_{b+1} = W E_b between patches, gathered by the texels.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "transport/trace_surface.h"

namespace hemibake {

struct BounceOptions {
  int bounces = 20;                          // stored one by one, 0..
  std::optional<double> converge_tolerance;  // go on until the worst texel's residual is below it
  int max_bounces = 2000;                    // the end of that in any case
};

struct Bounces {
  std::vector<Grid<float>> irradiance;  // E_0 … E_bounces, 0..π
  Grid<float> total;                    // Σ of all bounces made, 0..π
  Grid<float> residual;                 // (π − Σ)/π still under way
  int bounces_made = 0;
  double mean_residual = 0, worst_residual = 0;
  uint32_t worst_texel = 0;
  // Only with a tolerance: texels whose residual is not below it, and those among them whose every link leads
  // to themselves, so that no number of bounces would help.
  std::vector<uint32_t> texels_short, texels_closed;
};

Bounces bounce_light(const Visibility& seen, const BounceOptions& options);

}  // namespace hemibake
