// The result of an estimator.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec3.hpp>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// The truth that an AO stands for: the uniform visible fraction α, or the cosine-weighted one, E₀/π.
enum class AoKind { kUniform, kCosine };

struct Estimate {
  Grid<float> ao;  // per texel, 0..1, 1 = open
  AoKind kind = AoKind::kUniform;
  Grid<float> other_ao;          // of the other kind, where a method gives both; else empty
  Grid<glm::vec3> bent_normals;  // unit, per texel; empty if the method has none
  Grid<uint8_t> known;           // 0: the method does not know (AO is 1 there); empty: known everywhere
  uint64_t work = 0;             // tree nodes visited, taps or height samples read, over all passes
};

// Returns the default radius of the estimators: eight height ranges, at most four times the longer side.
// Farther heights of an endless map lie within atan(1/8) of the horizon: at most 1/8 of α and 1/64 of E₀/π
// for a level receiver.
inline double far_radius_m(const Surface& surface) {
  const double longer_side_m = surface.texel_size_m * std::max(surface.width(), surface.height());
  return std::min(8 * height_range_m(surface), 4 * longer_side_m);
}

}  // namespace hemibake
