#include "transport/series.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace hemibake {
namespace {

// Powers of two: every sum and product is exact.
constexpr std::array<double, 5> kHalves = {1, 0.5, 0.25, 0.125, 0.0625};

TEST(SumBounces, AddsGeometricBouncesExactly) {
  // (ρ/2)ᵇ at ρ = ½: Σ 4⁻ᵇ, b = 0 … 4.
  EXPECT_EQ(sum_bounces(kHalves, 0.5), 1 + 0.25 + 0.0625 + 0.015625 + 0.00390625);
}

TEST(SumBounces, GivesDirectLightAtAlbedo0AndThePlainSumAtAlbedo1) {
  EXPECT_EQ(sum_bounces(kHalves, 0), 1);
  EXPECT_EQ(sum_bounces(kHalves, 1), 1.9375);
}

TEST(SumBounces, GivesZeroWithoutBounces) {
  EXPECT_EQ(sum_bounces(std::span<const double>(), 0.5), 0);
  EXPECT_EQ(sum_bounces(std::array<double, 3>{}, 1), 0);
}

TEST(SumBounces, SumsOneTexelOfPlanes) {
  std::vector<Grid<float>> planes;
  for (const double light : kHalves) {
    planes.emplace_back(2, 1);
    planes.back()[1] = static_cast<float>(light);
  }
  for (const double albedo : {0.0, 0.3, 1.0}) {
    EXPECT_EQ(sum_bounces(planes, 0, albedo), 0);
    EXPECT_EQ(sum_bounces(planes, 1, albedo), sum_bounces(kHalves, albedo));
  }
}

TEST(SeriesTail, ContinuesAGeometricSeriesExactly) {
  // 2, 1, then ½ + ¼ + … = 1.
  EXPECT_EQ(series_tail(2, 1, 1), 1);
  EXPECT_EQ(series_tail(kHalves[3], kHalves[4], 1), 0.0625);
}

TEST(SeriesTail, SumAndTailTogetherAreTheWholeSeries) {
  for (const double albedo : {0.1, 0.5, 0.9}) {
    const double before = std::pow(albedo / 2, 3), last = std::pow(albedo / 2, 4);
    const double whole = sum_bounces(kHalves, albedo) + series_tail(before, last, albedo);
    // Five roundings of numbers near 1.
    EXPECT_NEAR(whole, 1 / (1 - albedo / 2), 5e-16 * 5);
  }
}

TEST(SeriesTail, LimitsTheRatioToTheAlbedo) {
  // Light still seeping in: more than the bounce before.
  EXPECT_EQ(series_tail(1, 2, 0.5), 2);
  EXPECT_EQ(series_tail(1, 0.75, 0.5), 0.75);
}

TEST(SeriesTail, StaysFiniteAtAlbedo1) {
  EXPECT_NEAR(series_tail(1, 1, 1), 999, 1e-9);  // 0.999 / (1 − 0.999): 1 − 0.999 is off by 10⁻¹³ of itself
}

TEST(SeriesTail, IsZeroWithoutLightOrAlbedo) {
  EXPECT_EQ(series_tail(0, 1, 1), 0);
  EXPECT_EQ(series_tail(1, 0, 1), 0);
  EXPECT_EQ(series_tail(1, 1, 0), 0);
}

TEST(SeriesTail, NeverExceedsTheBound) {
  EXPECT_EQ(series_tail(2, 1, 1, 0.25), 0.25);
  EXPECT_EQ(series_tail(2, 1, 1, 4), 1);
  EXPECT_EQ(series_tail(2, 1, 1, -0.5), 0);
}

}  // namespace
}  // namespace hemibake
