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

  // Adds green and alpha of a texel, for normal maps that store x in alpha (DXT5nm).
  void add_alpha(float green, float alpha);

  // Returns why green holds no heights, and what would be right; empty where it may hold them. Heights are
  // grey, tinted grey, or in green alone.
  std::string objection() const;

  // Returns what else green may hold, and what would then be right; empty where nothing speaks for it. Option
  // names stand in braces. For images without an objection.
  std::string doubt() const;

 private:
  using Triple = std::array<double, 3>;

  bool varies(size_t channel) const { return low_[channel] < high_[channel]; }
  double deviation(size_t channel) const;
  double correlation_with_green(size_t channel) const;
  bool differs_from_green(size_t channel) const;
  bool is_normal_map() const;
  bool is_green_alone() const { return !varies(0) && varies(1) && !varies(2); }
  bool is_alpha_normal_map() const;
  std::string split_objection() const;
  std::string constant_split_doubt() const;

  bool is_8_bit_, is_float_;
  uint64_t count_ = 0;
  Triple first_{}, low_{}, high_{}, sum_{}, square_{}, with_green_{};  // sums are of v − first
  double code_length_error_ = 0, signed_length_error_ = 0;             // Σ | |n| − 1 |
  std::array<int, 3> last_{};
  uint64_t alpha_count_ = 0, masked_ = 0, beyond_unit_ = 0;  // masked_: alpha is 0 or 1
  double first_alpha_ = 0, alpha_sum_ = 0, green_sum_ = 0;
  bool alpha_varies_ = false;
  SplitDetector red_green_, green_blue_;
};

}  // namespace hemibake
