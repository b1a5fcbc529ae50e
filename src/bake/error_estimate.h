// How far a bake is from the truth, told from the bake itself: each cause by itself, everything over π.
//
// Rays: a random sample of texels and of nodes is traced again with other rotations; the difference is noise.
// That of a texel's E₁ is its own rays' and that of the light they meet. The mean over the map averages both
// away. In the curve they remain: noise in α moves texels into other bins. For α + ε with density p and mean
// light f, Tweedie's formula (Efron, "Tweedie's formula and selection bias", 2011) gives what a bin shows too
// much: (f′ σ² − cov) p′/p + f″ σ²/2, σ² the variance of ε, cov its covariance with the noise of the light.
//
// Patches: light between every other node instead of all (Richardson). Linear elements err with the square of
// their size where light is smooth, and with the size itself in folds: measured, the difference shrinks to a
// half or a third when nodes are doubled (shapes, noise, concrete), so half of it is taken to be left.
//
// Bounces: what is still under way. Far horizon: rays cut short, as if all that is above them were surface.
#pragma once

#include <cstdint>

#include "surface/patches.h"
#include "tracers/tracer.h"
#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {

struct ErrorEstimate {
  // Standard deviations of one texel's noise.
  double ao_rays = 0, direct_rays = 0, first_rays = 0;
  // Standard errors of the means of E₀ and E₁ over the map.
  double mean_direct_rays = 0, mean_first_rays = 0;
  // Largest likely errors of the mean E₁ and of the mean total at albedo ½; 0 where patches are texels, whose
  // error only the referee knows.
  double first_patches = 0, half_patches = 0;
  // Light of the mean total still under way, at albedo 1 and ½.
  double total_bounces = 0, half_bounces = 0;
  double far_horizon = 0;
  // Errors of the curves of E₀ and E₁ over α: root mean square over the texels' bins.
  double curve_direct = 0, curve_first = 0;
};

// again: the same tracer with another seed. `seen` needs links.
ErrorEstimate estimate_errors(const Tracer& again, const LightTransport& seen, const Bounces& bounces);

}  // namespace hemibake
