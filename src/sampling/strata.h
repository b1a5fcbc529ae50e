// A sample of a long row of things, spread evenly and yet at random.
#pragma once

#include <cstdint>
#include <vector>

namespace hemibake {

// `wanted` of [0, count), ascending, one at random in each of equal strata (a fixed step would meet the same
// columns of a map again and again); all where there are no more. stream: of the random numbers (mix_bits).
std::vector<uint32_t> stratified_sample(uint32_t count, uint32_t wanted, uint64_t stream);

}  // namespace hemibake
