#include "trade/errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/statistics.h"

namespace hemibake {
namespace {

constexpr size_t kBins = 100;

using BinMeans = std::array<Moments, kBins>;

bool is_known(std::span<const uint8_t> known, size_t texel) { return known.empty() || known[texel] != 0; }

BinMeans means_by_ao(std::span<const float> ao, std::span<const float> values,
                     std::span<const uint8_t> known) {
  expect_equal(ao.size(), values.size(), "texels of a curve");
  BinMeans bins;
  for (size_t i = 0; i < ao.size(); ++i) {
    if (!is_known(known, i)) continue;
    const double position = std::floor(static_cast<double>(ao[i]) * kBins);
    bins[static_cast<size_t>(std::clamp(position, 0.0, kBins - 1.0))].add(static_cast<double>(values[i]));
  }
  return bins;
}

}  // namespace

ErrorStatistics error_of(std::span<const float> estimate, std::span<const float> truth,
                         std::span<const uint8_t> known) {
  expect_equal(estimate.size(), truth.size(), "texels of an estimate");
  std::vector<double> sizes;
  double sum = 0, squares = 0;
  for (size_t i = 0; i < estimate.size(); ++i) {
    if (!is_known(known, i)) continue;
    const double difference = static_cast<double>(estimate[i]) - static_cast<double>(truth[i]);
    sum += difference;
    squares += difference * difference;
    sizes.push_back(std::abs(difference));
  }
  ErrorStatistics error;
  if (sizes.empty()) return error;
  const double count = static_cast<double>(sizes.size());
  error.rmse = std::sqrt(squares / count);
  error.bias = sum / count;
  error.largest = *std::ranges::max_element(sizes);
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.99 * count)) - 1;
  std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
  error.p99 = sizes[static_cast<size_t>(rank)];
  return error;
}

CurveError curve_error(std::span<const float> ao, std::span<const float> values,
                       std::span<const float> true_ao, std::span<const float> true_values,
                       std::span<const uint8_t> known) {
  const BinMeans estimate = means_by_ao(ao, values, known), truth = means_by_ao(true_ao, true_values, {});
  CurveError error;
  double weights = 0, squares = 0;
  for (size_t j = 0; j < kBins; ++j) {
    if (std::min(estimate[j].count, truth[j].count) < kSmallestBin) continue;
    const double weight = static_cast<double>(truth[j].count);
    const double difference = estimate[j].mean - truth[j].mean;
    ++error.bins;
    weights += weight;
    error.bias += weight * difference;
    squares += weight * difference * difference;
    error.largest = std::max(error.largest, std::abs(difference));
  }
  if (weights == 0) return error;
  error.bias /= weights;
  error.rms = std::sqrt(squares / weights);
  return error;
}

}  // namespace hemibake
