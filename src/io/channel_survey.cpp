#include "io/channel_survey.h"

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

std::string ChannelSurvey::objection() const {
  if (count_ < 2) return "";
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
