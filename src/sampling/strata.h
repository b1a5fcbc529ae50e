// Draws a random sample of a long sequence, spread evenly over it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sampling/low_discrepancy.h"

namespace hemibake {

// Returns `wanted` numbers of [0, count), ascending: one at random in each of equal strata, or all if there
// are fewer. (A fixed step would meet the same columns of a map again and again.) stream: of mix_bits.
inline std::vector<uint32_t> stratified_sample(uint32_t count, uint32_t wanted, uint64_t stream) {
  std::vector<uint32_t> indices(std::min(count, wanted));
  for (uint32_t i = 0; i < indices.size(); ++i) {
    const double index = (i + unit_interval(mix_bits(0, stream, i))) / static_cast<double>(indices.size());
    indices[i] = std::min(count - 1, static_cast<uint32_t>(index * count));
  }
  return indices;
}

}  // namespace hemibake
