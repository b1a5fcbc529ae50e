// Measures light by reference path tracing: the unbiased judge of the bake. It includes nothing of the
// tracers, the transport or the direction sets: ray caster in double precision, random numbers and estimator
// are its own.
//
// A path starts at a receiver, cosine-distributed about the receiver's normal. Where it meets the surface it
// goes on from the exact point, cosine-distributed about the facet's own normal. E_b/π is the probability
// that it escapes after exactly b reflections, the total at albedo ρ is the mean of ρᵇ. Nothing is clamped,
// and no bounce is the last.
//
// Starts and hits are lifted vertically before a path goes on, by a millionth of a texel by default. Rays do
// not leak (ray_caster.h), so the lift only clears rounding, and decides which of the facets around a texel
// centre is met by directions below the ground: the limit is the surface itself.
//
// Splitting: paths run in groups of 64. After every bounce the paths of a group that hit are copied (or
// thinned) to 64 again by systematic resampling, each copy carrying the same share of their weight: a hit
// point with weight w of the group's S has on average 64 w/S copies of weight S/64, so every estimate stays
// unbiased, while late bounces get as many paths as the first. (Gordon, Salmond, Smith, "Novel approach to
// nonlinear/non-Gaussian Bayesian state estimation", 1993; unbiasedness: Del Moral, "Feynman-Kac Formulae",
// 2004, 7.4.) Paths within a group are dependent, groups are not: standard errors come from the spread
// between groups. After the last bounce measured by itself, paths go on without splitting, ended by Russian
// roulette at the largest albedo that a total still needs.
//
// Ground beyond the border (Edge::kGround) looks as what else of the surface is seen from the same point
// (path_step.h).
//
// Results have the same bytes at any thread count.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "surface/surface.h"

namespace hemibake {

// Paths that are split together.
inline constexpr uint32_t kRefereeGroupPaths = 64;

// Σ_b ρᵇ E_b/π over b = 0 … last_bounce.
struct RefereeTotal {
  static constexpr int kUnlimited = -1;
  double albedo = 0.5;           // ρ, 0..1; at 1 without limit it is exactly 1 and slow to find out
  int last_bounce = kUnlimited;  // at least RefereeOptions::bounces, or kUnlimited
};

struct RefereeOptions {
  int paths = 1024;  // per receiver: rounded up to whole groups of 64, at least two groups
  int bounces = 2;   // E_0 … E_bounces are measured, 0..
  std::vector<RefereeTotal> totals = std::vector<RefereeTotal>(1);  // one, at albedo 0.5
  uint64_t seed = 0;
  double lift_texels = 1e-6;  // above 0; less on maps with less relief than a texel
};

// Measurements of some receivers. Quantities: E_0/π … E_bounces/π, then totals/π in the order of the options.
struct RefereeEstimates {
  int quantities = 0;
  uint32_t groups = 0;           // independent estimates behind each mean, at least 2
  std::vector<double> mean;      // [receiver · quantities + quantity]
  std::vector<double> variance;  // of that mean, unbiased
  uint64_t rays = 0;
  uint64_t truncated_rays = 0;  // taken for sky: estimates are off by at most truncated rays / paths

  uint64_t paths() const { return uint64_t{groups} * kRefereeGroupPaths; }  // per receiver
  size_t receivers() const { return quantities == 0 ? 0 : mean.size() / static_cast<size_t>(quantities); }
  size_t index(size_t receiver, int quantity) const {
    return receiver * static_cast<size_t>(quantities) + static_cast<size_t>(quantity);
  }
};

// A measured mean with its interval: mean ± half_width.
struct RefereeInterval {
  double mean = 0;
  double half_width = 0;
  bool contains(double value) const { return value >= mean - half_width && value <= mean + half_width; }
};

// Measures texels at their centres about their shading normals, one receiver each.
// texels: row-major indices. Throws InputError for options out of range.
RefereeEstimates referee_texels(const Surface& surface, std::span<const uint32_t> texels,
                                const RefereeOptions& options);

// Returns α of texels by stratified rays: one at random in each cell of equal solid angle of the hemisphere
// about the shading normal.
// texels: row-major indices. rays: per texel, rounded up to a square, 1..; less throws InputError.
std::vector<double> referee_visible_fractions(const Surface& surface, std::span<const uint32_t> texels,
                                              int rays, uint64_t seed);

// Measures the surface as one receiver: the mean over its area about the facets' normals.
RefereeEstimates referee_area(const Surface& surface, const RefereeOptions& options);

// Returns the interval of a mean by Student's t with groups − 1 degrees of freedom.
// confidence: in (0, 1).
RefereeInterval referee_interval(const RefereeEstimates& estimates, size_t receiver, int quantity,
                                 double confidence);

}  // namespace hemibake
