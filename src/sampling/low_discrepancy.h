// Low-discrepancy numbers and the hash that rotates them. Source: Pharr, Jakob, Humphreys, "Physically Based
// Rendering", 4th ed. 2023, 8.6 (radical inverse, Hammersley points), 8.6.3 (Cranley-Patterson rotation).
#pragma once

#include <cmath>
#include <cstdint>

namespace hemibake {

// Returns the digits of `index` in `base` mirrored about the point, in [0, 1).
inline double radical_inverse(uint32_t base, uint32_t index) {
  const double digit_value = 1.0 / base;
  double scale = digit_value, result = 0;
  for (; index > 0; index /= base, scale *= digit_value) result += scale * (index % base);
  return result;
}

// Returns 64 well-mixed bits of (seed, stream, index). Every random number is one of these, so that it can be
// had again from its purpose.
inline uint64_t mix_bits(uint64_t seed, uint64_t stream, uint64_t index) {
  // SplitMix64 finaliser (Steele, Lea, Flood 2014), applied per word.
  const auto finalise = [](uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  };
  return finalise(finalise(finalise(seed + 0x9e3779b97f4a7c15ull) + stream) +
                  0x9e3779b97f4a7c15ull * (index + 1));
}

// Returns a number uniform in [0, 1) from the upper 53 bits.
inline double unit_interval(uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

// Returns u shifted round the unit interval by `shift`; both in [0, 1).
inline double cranley_patterson_rotate(double u, double shift) {
  const double sum = u + shift;
  return sum >= 1 ? sum - 1 : sum;
}

}  // namespace hemibake
