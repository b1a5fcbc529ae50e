// Sends light round at albedo 1: E_{b+1} = W E_b between patches, with a final gather at the texels.
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
  std::optional<double> converge_tolerance;  // if set: go on until every |residual| is below it
  int max_bounces = 2000;                    // limit of bounces and of the solver's products
  std::optional<double> bounce_albedo = {};  // if set, inside 0..1: albedo of `Bounces::at_albedo`
};

struct Bounces {
  std::vector<Grid<float>> irradiance;  // E_0 … E_bounces, 0..π
  Grid<float> total;                    // Σ of all bounces made, or converged, 0..π
  // (π − Σ)/π still under way. Converged, it may be negative by less than the tolerance: the solver comes
  // near the sum from both sides. Unconverged texels keep the sum of the stored bounces.
  Grid<float> residual;
  Grid<float> at_albedo;  // E/π of all bounces at `bounce_albedo`, to 10⁻⁴ in the worst texel; 0..1
  int bounces_made = 0;   // stored, and products of the patch form factors to converge
  double mean_residual = 0, worst_residual = 0;
  uint32_t worst_texel = 0;
  // With a tolerance: texels whose residual is not below it, and those of them that see only themselves,
  // which no number of bounces would help.
  std::vector<uint32_t> unconverged_texels, enclosed_texels;
};

// Bounces the light of a uniform sky. transport: with form factors.
Bounces bounce_light(const LightTransport& transport, const BounceOptions& options);

// Computes the residual of every texel, their mean and the worst. total_over_pi: Σ/π of a texel.
void compute_residual(const std::function<double(size_t)>& total_over_pi, int width, int height,
                      Bounces& result);

}  // namespace hemibake
