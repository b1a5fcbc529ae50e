#include "io/height_sink.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"

namespace hemibake {
namespace {

// Sentinels like -3.4e38 are written with few digits.
constexpr double kLeastRoundedSentinel = 1e30, kSentinelRounding = 1e-2;

}  // namespace

HeightSink::HeightSink(std::filesystem::path path, int width, int height, std::optional<double> no_data)
    : path_(std::move(path)), no_data_(no_data), values_(width, height), holes_(width, height, uint8_t{0}) {
  if (no_data_ && std::abs(*no_data_) > kLeastRoundedSentinel)
    tolerance_ = kSentinelRounding * std::abs(*no_data_);
  else if (no_data_)
    tolerance_ = 1e-7 * std::abs(*no_data_);  // floats hold 24 bits of it
}

void HeightSink::put(size_t texel, double stored, float value) {
  if (std::isnan(stored) || (no_data_ && std::abs(stored - *no_data_) <= tolerance_)) {
    mark_hole(texel);
    return;
  }
  if (std::isinf(value)) {
    const auto width = static_cast<size_t>(values_.width);
    throw InputError(fmt::format("{}: height is {} at texel {},{}, expected a finite number", path_.string(),
                                 value, texel % width, texel / width));
  }
  values_[texel] = value;
}

void HeightSink::mark_hole(size_t texel) {
  values_[texel] = 0;
  hole_count_ += 1 - holes_[texel];
  holes_[texel] = 1;
}

void HeightSink::finish(HeightFile& file) {
  if (hole_count_ == values_.size())
    throw InputError(fmt::format("{}: has no height in any texel, expected some", path_.string()));
  file.values = std::move(values_);
  if (hole_count_ > 0) file.holes = std::move(holes_);
}

}  // namespace hemibake
