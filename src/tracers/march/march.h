// Marches rays over the height map one texel at a time, to the first sample below it: the experiment of 2018.
// Texels are the patches; a hit gives one texel its form factor. Source: B. Mayaux, "Study Notes: Improved
// Ambient Occlusion", 2018, and its program (github.com/Patapom/GodComplex,
// Tests/TestGroundTruthAOFitting).
//
// A ray starts over the texel's centre, lifted vertically, and advances one texel horizontally a step (a ray
// straight up, one texel vertically). At or above the amplitude it is sky, after `max_steps` too. A hit steps
// back by the fraction (H − z)/(2z − d + H − H') of the step: H the height there, z the ray's height, d the
// rise of a step, H' the height one step before (at the first step the start of the ray). The formula is not
// the crossing of the two lines, which would be (H − z)/(H − H' − d), and depends on where heights count
// from: the lowest texel, so that an offset of the map changes nothing, and height-map value 0 in 2018. About
// 3 of 10⁵ rays give a fraction outside 0..1, clamped here.
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
  kRotated,  // centred Hammersley points, rotated about the normal by each texel's own angle
  // One set for all texels: cosθ = c + (1 − c) u, c = cos(cone/2), u = (i mod N)/N, azimuth 2π · radical
  // inverse of i, i = 1..N, from −y of the tangent frame towards +x.
  kMayaux2018,
};

enum class MarchWeights {
  kExact,  // cosθ / Σ cosθ: Σ links + E₀/π = 1
  // 2 cosθ / N: E₀/π and row sums reach 2 · mean cosθ, 1.007758 with the rays of 2018, up to 2 in a narrow
  // cone.
  kMayaux2018,
};

enum class MarchLookup {
  kBilinear,
  // As the sampler of 2018: bilinear weights rounded to 1/256, and beyond the border texels' centres the
  // border's height instead of the one across the seam; heights count from height-map value 0.
  kMayaux2018,
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

  // Metres per unit of height-map value, >= 0; 0: the height range. The sky begins at the amplitude, but
  // never below the highest texel.
  double amplitude_m = 0;
  // With the lookup of 2018, height of the surface's zero: amplitude_m times the lowest height-map value
  // (after filtering).
  double lowest_m = 0;
  // Length of each normal as its map stores it (normal_map_lengths); empty: all 1. The program of 2018 did
  // not renormalise: rays are stretched with the normal, which bends them away from their angle and moves
  // hits by distance · (length − 1).
  Grid<float> normal_lengths;
};

// Returns the settings of 2018: 1024 rays, 179°, 200 steps, and kMayaux2018 throughout. amplitude_m, lowest_m
// and normal_lengths are the map's: set them, and filter the heights first (surface/filter.h).
MarchOptions mayaux2018_march();

// Makes a marching tracer. `surface` must outlive it.
std::unique_ptr<Tracer> make_march_tracer(const Surface& surface, MarchOptions options);

}  // namespace hemibake
