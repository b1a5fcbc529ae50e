// Options shared by the tracers.
#pragma once

#include <cstdint>
#include <limits>

#include "sampling/directions.h"
#include "tracers/tracer.h"

namespace hemibake {

// How a hit becomes links where patches are texels: to the nearest texel, or spread over the four around it.
enum class TexelLinks { kNearest, kBilinear };

struct RayOptions {
  int rays = 256;             // per receiver, 1..2^20
  double cone_degrees = 180;  // full aperture about the normal, (0, 180]
  double max_distance_m = std::numeric_limits<double>::infinity();  // hits beyond are sky, > 0
  DirectionSet directions = DirectionSet::kUniform;                 // of texels; facets always use kCosine
  Patches patches = Patches::kFacets;
  TexelLinks texel_links = TexelLinks::kBilinear;
  uint64_t seed = 0;
};

}  // namespace hemibake
