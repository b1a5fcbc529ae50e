// Estimates horizon-based ambient occlusion as a shader does: in a few vertical slices the highest of a few
// height samples on either side bounds the sky, and each slice has a closed form.
//
// L. Bavoil, M. Sainz, R. Dimitrov, "Image-Space Horizon-Based Ambient Occlusion", SIGGRAPH 2008 talks; J.
// Jimenez, X. Wu, A. Pesce, A. Jarabo, "Practical Realtime Strategies for Accurate Indirect Occlusion", 2016
// (GTAO): the cosine-weighted integral of a slice between horizons h₁ ≤ 0 ≤ h₂ from the vertical, normal
// projected to angle γ, is ¼ Σ (−cos(2h − γ) + cos γ + 2h sin γ) times the projected normal's length; the
// uniform one ½((1 − cos h₁) + (1 − cos h₂)) without that length: two cosines more give both. With many
// azimuths and steps both are the truth, as far as the radius reaches.
#pragma once

#include <cstdint>

#include "estimators/estimate.h"

namespace hemibake {

struct HorizonOptions {
  int azimuths = 8;       // directions, two to a slice; even, 2..
  int steps = 8;          // height samples along each, 1..
  double radius_m = 0;    // farther heights do not count; 0: far_radius_m
  double step_power = 2;  // sample k of n lies at radius · ((k + u)/n)^power: near ones are closer together
  AoKind kind = AoKind::kCosine;
  bool jitter = true;  // rotates the azimuths and shifts the samples of every texel at random, else u = 1
  uint64_t seed = 0;
};

// Estimates AO of both kinds. Heights are those of the surface's triangles. Beyond the radius an endless map
// fills all below the horizontal, ground beyond the border does so too, and beyond an open edge is nothing.
// Bent normals: the mean direction of the sky seen.
Estimate estimate_horizon(const Surface& surface, const HorizonOptions& options);

}  // namespace hemibake
