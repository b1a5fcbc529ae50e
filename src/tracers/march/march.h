// The march of the published experiment: rays that go over the height map one texel at a time and end at the
// first sample below it. Texels are the patches; a hit links to one texel. Source: B. Mayaux, "Study Notes:
// Improved Ambient Occlusion", 2018, and its program (github.com/Patapom/GodComplex,
// Tests/TestGroundTruthAOFitting).
//
// A ray starts over the texel's centre, lifted vertically, and advances one texel horizontally a step (a ray
// straight up, one texel vertically). At or above the amplitude it is sky, after `max_steps` too. A hit steps
// back by the fraction (H − z)/(2z − d + H − H') of the step: H the height there, z the ray's height, d the
// rise of a step, H' the height one step before (at the first step the start of the ray). Heights count from
// height-map value 0: the formula is not invariant to an offset, and is not the crossing of the two lines,
// which would be (H − z)/(H − H' − d). About 3 of 10⁵ rays give a fraction outside 0..1, clamped here.
//
// It differs from the truth where a texel hides its own neighbour: nothing is hit within the first texel, and
// a wall is met at the texel after it.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "core/grid.h"
#include "surface/surface.h"
#include "tracers/tracer.h"

namespace hemibake {

enum class MarchRays {
  kRotated,  // centred Hammersley points, turned about the normal by each texel's own angle, as the other
             // tracers do
  // One set for all texels: cosθ = c + (1 − c) u, c = cos(cone/2), u = (i mod N)/N, azimuth 2π · radical
  // inverse of i, i = 1..N, from −y of the tangent frame towards +x.
  kPublished,
};

enum class MarchWeights {
  kExact,  // cosθ / Σ cosθ: Σ links + E₀/π = 1
  // 2 cosθ / N: E₀/π and row sums reach 2 · mean cosθ, 1.007758 with the published rays, and up to 2 in a
  // narrow cone.
  kPublished,
};

enum class MarchLookup {
  kBilinear,
  // As the published sampler read heights: bilinear weights rounded to 1/256, and beyond the border texels'
  // centres the border's height instead of the one across the seam.
  kPublished,
};

struct MarchOptions {
  int rays = 256;             // per texel, 1..2^20
  double cone_degrees = 180;  // full aperture about the normal, (0, 180]
  double max_distance_m = std::numeric_limits<double>::infinity();  // hits beyond are sky, > 0
  int max_steps = 200;                                              // >= 1
  double lift_percent = 1;  // of amplitude_m: height of a start over its texel, >= 0
  MarchRays ray_set = MarchRays::kRotated;
  MarchWeights weights = MarchWeights::kExact;
  MarchLookup lookup = MarchLookup::kBilinear;
  uint64_t seed = 0;  // of kRotated

  // What a Surface no longer knows of its map. amplitude_m: metres per unit of height-map value, >= 0; 0: the
  // height range. lowest_m: amplitude_m times the lowest height-map value (after filtering): what the
  // surface's zero stands for. The sky begins at the amplitude, but never below the highest texel.
  double amplitude_m = 0;
  double lowest_m = 0;
  // Length of each normal as its map stores it (normal_map_lengths); empty: all 1. The published program did
  // not renormalise: rays are then stretched with the normal, which bends them away from their angle, moves
  // hits by distance · (length − 1), and so makes the published curves what they are.
  Grid<float> normal_lengths;
};

// The published experiment: 1024 rays, 179°, 200 steps, and kPublished wherever there is a choice.
// amplitude_m, lowest_m and normal_lengths are the map's: set them, and filter the heights first
// (surface/filter.h).
MarchOptions published_march();

// `surface` must outlive the tracer.
std::unique_ptr<Tracer> make_march_tracer(const Surface& surface, MarchOptions options);

}  // namespace hemibake
