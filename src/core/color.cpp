#include "core/color.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace hemibake {

double luminance(const glm::dvec3& linear) {
  return 0.2126 * linear.x + 0.7152 * linear.y + 0.0722 * linear.z;
}

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

Grid<glm::vec3> encode_srgb(const Grid<glm::vec3>& linear, double exposure_ev, Clipping& clipping) {
  const double gain = std::exp2(exposure_ev);
  Grid<glm::vec3> encoded(linear.width, linear.height);
  for (size_t i = 0; i < linear.size(); ++i) {
    bool above = false, below = false;
    for (int c = 0; c < 3; ++c) {
      const double value = gain * static_cast<double>(linear[i][c]);
      above |= value > 1;
      below |= value < 0;
      encoded[i][c] = static_cast<float>(srgb_from_linear(std::clamp(value, 0.0, 1.0)));
    }
    clipping.above_white += above;
    clipping.below_black += below;
  }
  return encoded;
}

double exposure_for(std::span<const Grid<glm::vec3>* const> pictures) {
  std::vector<float> brightest;
  for (const Grid<glm::vec3>* picture : pictures)
    for (const glm::vec3& value : picture->values) brightest.push_back(std::max({value.x, value.y, value.z}));
  if (brightest.empty()) return 0;
  const auto place = brightest.end() - 1 - static_cast<std::ptrdiff_t>(brightest.size() / 1000);
  std::nth_element(brightest.begin(), place, brightest.end());
  // Below the least normal number a screen has nothing to show.
  if (!(*place >= 1e-37f)) return 0;
  return std::floor(-4 * std::log2(static_cast<double>(*place))) / 4;
}

}  // namespace hemibake
