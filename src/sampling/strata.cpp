#include "sampling/strata.h"

#include <algorithm>

#include "sampling/low_discrepancy.h"

namespace hemibake {

std::vector<uint32_t> stratified_sample(uint32_t count, uint32_t wanted, uint64_t stream) {
  std::vector<uint32_t> places(std::min(count, wanted));
  for (uint32_t i = 0; i < places.size(); ++i) {
    const double place = (i + unit_interval(mix_bits(0, stream, i))) / static_cast<double>(places.size());
    places[i] = std::min(count - 1, static_cast<uint32_t>(place * count));
  }
  return places;
}

}  // namespace hemibake
