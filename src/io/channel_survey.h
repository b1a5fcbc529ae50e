// Tells from statistics what the red, green and blue of an image hold: heights, or something else.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "io/split_heights.h"

namespace hemibake {

class ChannelSurvey {
 public:
  // is_8_bit: split heights are possible. is_float: values may have any range.
  ChannelSurvey(bool is_8_bit, bool is_float) : is_8_bit_(is_8_bit), is_float_(is_float) {}

  // Adds a texel. begins_row: it has no neighbour before it. Values that are not finite are left out.
  void add(float r, float g, float b, bool begins_row);

  // Returns why green holds no heights, and what would be right; empty where it may hold them. Heights are
  // grey, tinted grey, or in green alone.
  std::string objection() const;

 private:
  using Triple = std::array<double, 3>;

  bool varies(size_t channel) const { return low_[channel] < high_[channel]; }
  double deviation(size_t channel) const;
  double correlation_with_green(size_t channel) const;
  bool differs_from_green(size_t channel) const;
  bool is_normal_map() const;
  std::string split_objection() const;

  bool is_8_bit_, is_float_;
  uint64_t count_ = 0;
  Triple first_{}, low_{}, high_{}, sum_{}, square_{}, with_green_{};  // sums are of v − first
  double code_length_error_ = 0, signed_length_error_ = 0;             // Σ | |n| − 1 |
  std::array<int, 3> last_{};
  SplitDetector red_green_, green_blue_;
};

}  // namespace hemibake
