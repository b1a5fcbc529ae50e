#include "io/channel_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hemibake {
namespace {

// Mean deviation of normals from length 1, of the mean normal from upright in x and y, and its least z.
// 8-bit codes and filtered maps stay far below.
constexpr double kMostLengthError = 0.12, kMostLean = 0.25, kLeastUp = 0.3;
// Channels that correlate less are not one grey, unless the rest is noise of compression.
constexpr double kLeastCorrelation = 0.985, kMostNoise = 0.02;
// Red of a Terrarium tile: 127 is the sea's floor to −256 m, 164 is 9216 m. Of a Mapbox tile: 4 is 16 km.
constexpr double kTerrariumLow = 120, kTerrariumHigh = 164, kMapboxHigh = 4;

// Share of texels where alpha is 0 or 1 from which it is a mask; of vectors longer than 1 below which two
// channels are x and y; x² + y² that rounding and compression do not reach.
constexpr double kMaskShare = 0.5, kMostBeyondUnit = 0.001, kBeyondUnit = 1.08;

double length(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

}  // namespace

void ChannelSurvey::add(float r, float g, float b, bool begins_row) {
  if (!std::isfinite(r) || !std::isfinite(g) || !std::isfinite(b)) return;
  const Triple value{r, g, b};
  if (count_ == 0) first_ = low_ = high_ = value;
  ++count_;
  for (size_t c = 0; c < 3; ++c) {
    const double shifted = value[c] - first_[c];
    low_[c] = std::min(low_[c], value[c]);
    high_[c] = std::max(high_[c], value[c]);
    sum_[c] += shifted;
    square_[c] += shifted * shifted;
    with_green_[c] += shifted * (value[1] - first_[1]);
  }
  code_length_error_ += std::abs(length(2 * value[0] - 1, 2 * value[1] - 1, 2 * value[2] - 1) - 1);
  signed_length_error_ += std::abs(length(value[0], value[1], value[2]) - 1);
  if (!is_8_bit_) return;
  std::array<int, 3> stored;
  for (size_t c = 0; c < 3; ++c) stored[c] = static_cast<int>(std::lround(255 * value[c]));
  if (!begins_row) {
    red_green_.add(stored[0] - last_[0], stored[1] - last_[1]);
    green_blue_.add(stored[1] - last_[1], stored[2] - last_[2]);
  }
  last_ = stored;
}

void ChannelSurvey::add_alpha(float green, float alpha) {
  if (!std::isfinite(green) || !std::isfinite(alpha)) return;
  const double y = 2 * static_cast<double>(green) - 1, x = 2 * static_cast<double>(alpha) - 1;
  if (alpha_count_++ == 0) first_alpha_ = x;
  alpha_varies_ = alpha_varies_ || x != first_alpha_;
  masked_ += std::abs(x) == 1;
  beyond_unit_ += x * x + y * y > kBeyondUnit;
  alpha_sum_ += x;
  green_sum_ += y;
}

bool ChannelSurvey::is_alpha_normal_map() const {
  const auto n = static_cast<double>(alpha_count_);
  if (!alpha_varies_ || static_cast<double>(masked_) > kMaskShare * n) return false;
  return std::abs(alpha_sum_) < kMostLean * n && std::abs(green_sum_) < kMostLean * n &&
         static_cast<double>(beyond_unit_) <= kMostBeyondUnit * n;
}

double ChannelSurvey::deviation(size_t channel) const {
  const auto n = static_cast<double>(count_);
  const double mean = sum_[channel] / n;
  return std::sqrt(std::max(0.0, square_[channel] / n - mean * mean));
}

double ChannelSurvey::correlation_with_green(size_t channel) const {
  const auto n = static_cast<double>(count_);
  const double covariance = with_green_[channel] / n - sum_[channel] / n * (sum_[1] / n);
  const double scale = deviation(channel) * deviation(1);
  return scale > 0 ? covariance / scale : 0;
}

bool ChannelSurvey::differs_from_green(size_t channel) const {
  if (!varies(channel) || !varies(1)) return false;
  const double correlation = correlation_with_green(channel);
  if (correlation >= kLeastCorrelation) return false;
  const double rest = deviation(channel) * std::sqrt(std::max(0.0, 1 - correlation * correlation));
  return is_float_ || correlation < 0 || rest > kMostNoise;
}

bool ChannelSurvey::is_normal_map() const {
  if (!varies(0) && !varies(1)) return false;  // one colour
  const auto n = static_cast<double>(count_);
  Triple mean;
  for (size_t c = 0; c < 3; ++c) mean[c] = first_[c] + sum_[c] / n;
  const auto leans = [](const Triple& v) {
    return std::abs(v[0]) > kMostLean || std::abs(v[1]) > kMostLean || v[2] < kLeastUp;
  };
  if (code_length_error_ < kMostLengthError * n)
    return !leans({2 * mean[0] - 1, 2 * mean[1] - 1, 2 * mean[2] - 1});
  return is_float_ && signed_length_error_ < kMostLengthError * n && !leans(mean);
}

// Names the encodings that fit the range of red.
std::string ChannelSurvey::split_objection() const {
  const bool upper = red_green_.is_split(), lower = green_blue_.is_split();
  if (!is_8_bit_ || (!upper && !lower)) return "";
  const std::string begin = "looks like heights split over channels of 8 bits, expected --encoding ";
  const std::string end = ", or --channel G where green alone is the height";
  const bool is_low = 255 * high_[0] <= kMapboxHigh;
  const bool is_terrarium = 255 * low_[0] >= kTerrariumLow && 255 * high_[0] <= kTerrariumHigh;
  if (!varies(2)) return begin + (is_terrarium ? "rg16 or terrarium" : "rg16") + end;
  if (is_terrarium) return begin + "terrarium" + end;
  if (is_low) return begin + "mapbox" + end;
  return begin + (upper ? "rg16, terrarium or mapbox" : "terrarium or mapbox") + end;
}

// Says which split heights would have the constant red and blue; empty where none would.
std::string ChannelSurvey::constant_split_doubt() const {
  if (!is_8_bit_) return "";
  const long red = std::lround(255 * first_[0]), blue = std::lround(255 * first_[2]);
  if (static_cast<double>(red) >= kTerrariumLow && static_cast<double>(red) <= kTerrariumHigh)
    return blue == 0 ? "{encoding} terrarium or rg16" : "{encoding} terrarium";
  if (red > 0 && static_cast<double>(red) <= kMapboxHigh)
    return blue == 0 ? "{encoding} mapbox or rg16" : "{encoding} mapbox";
  return blue == 0 ? "{encoding} rg16" : "{encoding}";
}

std::string ChannelSurvey::doubt() const {
  if (count_ < 2 || !varies(1)) return "";
  constexpr const char* kNormals =
      "{normals} with {normal-channels} A,G where it is a normal map (x in alpha, y in green: DXT5nm)";
  const bool is_grey = !is_green_alone() && !differs_from_green(0) && !differs_from_green(2);
  if (is_grey && is_alpha_normal_map())
    return fmt::format(
        "alpha varies about the middle as green does: expected {}, {{channel}} G where green is "
        "the height",
        kNormals);
  const bool is_plain = first_[0] == 0 && first_[2] == 0;
  if (!is_green_alone() || (is_plain && !alpha_varies_)) return "";
  if (alpha_varies_ && static_cast<double>(masked_) <= kMaskShare * static_cast<double>(alpha_count_))
    return fmt::format(
        "only green and alpha vary: expected {{channel}} G or A to say which is the height, or {}", kNormals);
  if (is_plain) return "";
  const std::string split = constant_split_doubt();
  const double scale = is_8_bit_ ? 255 : 1;
  return fmt::format(
      "only green varies, red is {:g} and blue {:g} everywhere, and is taken as the height: expected "
      "{{channel}} G "
      "if it is, {}or {{normals}} where it is a normal map",
      scale * first_[0], scale * first_[2],
      split.empty() ? "" : split + " where heights are split over channels, ");
}

std::string ChannelSurvey::objection() const {
  if (count_ < 2) return "";
  if (is_green_alone() && is_alpha_normal_map())
    return "looks like a normal map (x in alpha, y in green: DXT5nm), expected heights; --channel names the "
           "channel that holds them, --normals with --normal-channels A,G takes a normal map";
  if (is_normal_map())
    return "looks like a normal map (vectors of length 1), expected heights; --channel names the channel "
           "that "
           "holds them, --normals takes a normal map";
  if (std::string split = split_objection(); !split.empty()) return split;
  if (differs_from_green(0) || differs_from_green(2))
    return "looks like a colour picture (red, green and blue differ), expected heights; --channel G takes "
           "green, --encoding joins split channels";
  return "";
}

}  // namespace hemibake
