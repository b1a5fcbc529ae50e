// How far a plane is from the truth, and how far a curve.
#pragma once

#include <cstdint>
#include <span>

namespace hemibake {

// Measures estimate − truth over texels.
struct ErrorStatistics {
  double rmse = 0;
  double bias = 0;     // mean
  double largest = 0;  // largest |difference|
  double p99 = 0;      // 99th percentile of |difference|: the smallest value that 99 % do not exceed
};

// Over the texels that are known (`known` empty: all). All 0 where none is. Spans of equal length.
ErrorStatistics error_of(std::span<const float> estimate, std::span<const float> truth,
                         std::span<const uint8_t> known);

// Difference between two curves: the means of `values` over texels sorted by AO into 100 bins, each bin
// counting by its number of true texels.
struct CurveError {
  double bias = 0, rms = 0, largest = 0;
  int bins = 0;  // compared: those with at least kSmallestBin texels in both
};

inline constexpr int kSmallestBin = 10;

// An AO that is wrong moves texels into other bins, so that even true values give a wrong curve.
CurveError curve_error(std::span<const float> ao, std::span<const float> values,
                       std::span<const float> true_ao, std::span<const float> true_values,
                       std::span<const uint8_t> known);

}  // namespace hemibake
