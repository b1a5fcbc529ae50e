#include "io/split_heights.h"

#include <cstdlib>

namespace hemibake {
namespace {

// A sawtooth of 256 values falls back by more than half of them.
constexpr int kLeastWrap = 128;
constexpr uint64_t kLeastSteps = 8;
// Of the steps of one of the upper channel, those that must wrap the lower: tenths.
constexpr uint64_t kLeastWrapped = 9;
// Noise of 0..255 steps by 85 in the mean; a smooth channel by a fraction of that.
constexpr uint64_t kLeastNoise = 60, kLeastRatio = 4;

}  // namespace

double join_split_height(SplitEncoding encoding, double r, double g, double b) {
  switch (encoding) {
    case SplitEncoding::kTerrarium:
      return r * 256 + g + b / 256 - 32768;
    case SplitEncoding::kMapbox:
      return (65536 * r + 256 * g + b) * 0.1 - 10000;
    case SplitEncoding::kRg16:
      return 256 * r + g;
    case SplitEncoding::kNone:
      break;
  }
  return g;
}

void SplitDetector::add(int upper_step, int lower_step) {
  ++count_;
  upper_sum_ += static_cast<uint64_t>(std::abs(upper_step));
  lower_sum_ += static_cast<uint64_t>(std::abs(lower_step));
  if (std::abs(upper_step) != 1) return;
  ++unit_steps_;
  if (-upper_step * lower_step > kLeastWrap) ++wrapped_steps_;
}

bool SplitDetector::is_split() const {
  if (unit_steps_ >= kLeastSteps && wrapped_steps_ * 10 >= unit_steps_ * kLeastWrapped) return true;
  return upper_sum_ >= kLeastSteps && lower_sum_ >= kLeastNoise * count_ &&
         lower_sum_ >= kLeastRatio * upper_sum_;
}

}  // namespace hemibake
