// Sums the bounces of light: Σ_b ρᵇ E_b of bounces stored at albedo 1, and the tail after the last of them.
#pragma once

#include <limits>
#include <span>

#include "core/grid.h"

namespace hemibake {

// Returns Σ_b ρᵇ E_b, b = 0 … count − 1, in double from the first bounce to the last.
// light: E_b at albedo 1 as light(b), in any unit. albedo: ρ, 0..1. None: 0.
template <class Light>
double sum_bounces(size_t count, const Light& light, double albedo) {
  double sum = 0, power = 1;
  for (size_t b = 0; b < count; ++b, power *= albedo) sum += power * static_cast<double>(light(b));
  return sum;
}

// Returns Σ_b ρᵇ E_b of one receiver. bounces: E_0, E_1, … at albedo 1.
inline double sum_bounces(std::span<const double> bounces, double albedo) {
  return sum_bounces(
      bounces.size(), [&](size_t b) { return bounces[b]; }, albedo);
}

// Returns Σ_b ρᵇ E_b of one texel. bounces: planes E_0, E_1, … at albedo 1. texel: row-major index.
inline double sum_bounces(std::span<const Grid<float>> bounces, size_t texel, double albedo) {
  return sum_bounces(
      bounces.size(), [&](size_t b) { return bounces[b][texel]; }, albedo);
}

// Returns the light of all bounces after the last: last · (q + q² + …) = last · q / (1 − q),
// q = min(last / before, albedo, 0.999); 0 where a bounce is dark.
// before, last: the last two bounces as they arrive, powers of the albedo included, in one unit, 0... In a
// pit that light still seeps into, last may exceed before: no bounce sends on more than the albedo. albedo:
// the largest of the surface, 0..1. most: bound of the tail in the unit of the light, for instance the energy
// still under way; below 0 counts as 0.
double series_tail(double before, double last, double albedo,
                   double most = std::numeric_limits<double>::infinity());

}  // namespace hemibake
