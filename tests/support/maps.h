// Surfaces that tests share.
#pragma once

#include "sampling/low_discrepancy.h"
#include "surface/surface.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {

// Every height an independent random number: as rough as a map can be.
inline Surface white_noise_surface(int width, int height, double amplitude_m, Edge edge = Edge::kWrap) {
  Grid<float> heights(width, height);
  for (size_t i = 0; i < heights.size(); ++i)
    heights[i] = static_cast<float>(unit_interval(mix_bits(7, 7, i)));
  return make_surface(std::move(heights), 1, amplitude_m, edge);
}

inline Surface synthetic_surface(SyntheticKind kind, int width, int height,
                                 std::optional<double> amplitude_m = {}, std::optional<double> angle_rad = {},
                                 Edge edge = Edge::kWrap) {
  SyntheticOptions options;
  options.width = width;
  options.height = height;
  options.angle_rad = angle_rad;
  SyntheticMap map = synthesize(kind, options);
  return make_surface(std::move(map.heights), 1, amplitude_m.value_or(map.recommended_amplitude_m), edge);
}

}  // namespace hemibake
