#include "trade/errors.h"

#include <gtest/gtest.h>

#include <vector>

#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

TEST(ErrorStatistics, AreWhatTheirNamesSay) {
  std::vector<float> truth(200, 0.5f), estimate = truth;
  // 1 % of 200 texels are two: they may lie beyond the 99th percentile, a third may not.
  estimate[3] = 1.5f;
  estimate[7] = 0.0f;
  estimate[11] = 0.75f;
  const ErrorStatistics error = error_of(estimate, truth, {});
  EXPECT_DOUBLE_EQ(error.bias, (1.0 - 0.5 + 0.25) / 200);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((1.0 + 0.25 + 0.0625) / 200));
  EXPECT_DOUBLE_EQ(error.largest, 1.0);
  EXPECT_DOUBLE_EQ(error.p99, 0.25);
}

TEST(ErrorStatistics, LeaveOutWhatIsNotKnown) {
  const std::vector<float> truth{0, 0, 0}, estimate{1, 9, -1};
  const std::vector<uint8_t> known{1, 0, 1};
  const ErrorStatistics error = error_of(estimate, truth, known);
  EXPECT_DOUBLE_EQ(error.bias, 0);
  EXPECT_DOUBLE_EQ(error.rmse, 1);
  EXPECT_DOUBLE_EQ(error.largest, 1);
  EXPECT_EQ(error_of(estimate, truth, std::vector<uint8_t>(3, 0)).rmse, 0);
}

// A straight curve v = α with an AO that is too high by 0.05: every bin shows values too low by as much.
TEST(CurveError, OfAShiftedAoIsTheShiftTimesTheSlope) {
  std::vector<float> ao, shifted, values;
  for (int i = 0; i < 20000; ++i) {
    const double a = 0.1 + 0.7 * (i + 0.5) / 20000;
    ao.push_back(static_cast<float>(a));
    shifted.push_back(static_cast<float>(a + 0.05));
    values.push_back(static_cast<float>(a));
  }
  EXPECT_EQ(curve_error(ao, values, ao, values, {}).largest, 0);
  const CurveError error = curve_error(shifted, values, ao, values, {});
  // Bins 15 to 79 have texels in both; 0.28 texels a bin of 1e-2 would be the quantisation, 3.5e-5.
  EXPECT_EQ(error.bins, 65);
  EXPECT_NEAR(error.bias, -0.05, 1e-4);
  EXPECT_NEAR(error.rms, 0.05, 1e-4);
  EXPECT_NEAR(error.largest, 0.05, 1e-4);
}

// Noise in AO biases the curve although no texel is biased. On v = α², with α uniform and noise
// of deviation s far from the ends, the bin at a gets E[(a − s x)²] = a² + s².
TEST(CurveError, OfNoisyAoIsTheCurvature) {
  std::vector<float> ao, noisy, values;
  constexpr double kSpread = 0.1;  // uniform noise ±0.1: variance 0.01/3
  constexpr int kTexels = 400000;
  for (int i = 0; i < kTexels; ++i) {
    const double a = (i + 0.5) / kTexels;
    const double noise = kSpread * (2 * unit_interval(mix_bits(1, 2, static_cast<uint64_t>(i))) - 1);
    // Only bins whose every texel's neighbourhood is inside 0..1 are compared.
    if (a < 0.1 || a > 0.9) continue;
    ao.push_back(static_cast<float>(a));
    noisy.push_back(static_cast<float>(a + noise));
    values.push_back(static_cast<float>(a * a));
  }
  std::vector<float> inside_ao, inside_values, inside_noisy, inside_noisy_values;
  for (size_t i = 0; i < ao.size(); ++i) {
    if (ao[i] >= 0.2f && ao[i] < 0.8f) {
      inside_ao.push_back(ao[i]);
      inside_values.push_back(values[i]);
    }
    if (noisy[i] >= 0.2f && noisy[i] < 0.8f) {
      inside_noisy.push_back(noisy[i]);
      inside_noisy_values.push_back(values[i]);
    }
  }
  const CurveError error = curve_error(inside_noisy, inside_noisy_values, inside_ao, inside_values, {});
  // 4000 texels a bin with a spread of at most 2·0.1/√3: 60 bins together err by 2.4e-4 a standard error.
  EXPECT_EQ(error.bins, 60);
  EXPECT_NEAR(error.bias, kSpread * kSpread / 3, 4 * 2.4e-4);
}

TEST(CurveError, OfNothingIsNothing) {
  EXPECT_EQ(curve_error({}, {}, {}, {}, {}).bins, 0);
  const std::vector<float> one{0.5f};
  EXPECT_EQ(curve_error(one, one, one, one, {}).bins, 0);
}

}  // namespace
}  // namespace hemibake
