#include "surface/filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Domain weights at a radius of 1 texel (sigma 1/3): beside, diagonal, two away, knight's move, two diagonal.
const double kBeside = std::exp(-4.5), kDiagonal = std::exp(-9.0), kTwo = std::exp(-18.0),
             kKnight = std::exp(-22.5), kTwoDiagonal = std::exp(-36.0);
const double kSum = 1 + 4 * kBeside + 4 * kDiagonal + 4 * kTwo + 8 * kKnight + 4 * kTwoDiagonal;

Grid<float> spike() {
  Grid<float> heights(9, 9, 0.25f);
  heights(4, 4) = 0.75f;
  return heights;
}

TEST(Filter, WithoutRangeWeightIsAGaussian) {
  const Grid<float> filtered = bilateral_filter(spike(), {1, kInfinity}, Edge::kWrap);
  EXPECT_NEAR(filtered(4, 4), 0.25 + 0.5 / kSum, 1e-7);
  for (const auto& [x, y] : {std::pair{3, 4}, {5, 4}, {4, 3}, {4, 5}})
    EXPECT_NEAR(filtered(x, y), 0.25 + 0.5 * kBeside / kSum, 1e-7);
  EXPECT_NEAR(filtered(3, 5), 0.25 + 0.5 * kDiagonal / kSum, 1e-7);
  EXPECT_EQ(filtered(7, 4), 0.25f);
}

TEST(Filter, WeighsHeightDifferences) {
  const Grid<float> filtered = bilateral_filter(spike(), {1, 0.2}, Edge::kWrap);
  const double range = std::exp(-0.5 * 0.5 * 0.5 / (0.2 * 0.2));
  EXPECT_NEAR(filtered(4, 4), 0.75 - 0.5 * (kSum - 1) * range / (1 + (kSum - 1) * range), 1e-7);
  EXPECT_NEAR(filtered(5, 4), 0.25 + 0.5 * kBeside * range / (kSum - kBeside + kBeside * range), 1e-7);
  EXPECT_EQ(bilateral_filter(spike(), {1, 1e-3}, Edge::kWrap).values, spike().values);
}

// One of the left neighbour, two of the right: a spike shows twice to its right.
TEST(Filter, PublishedSumDropsOddRowsAndDoublesTheLeftNeighbour) {
  FilterOptions options = mayaux2018_filter();
  EXPECT_EQ(options.radius, 1);
  EXPECT_EQ(options.tolerance, 0.2);
  options.tolerance = kInfinity;
  const Grid<float> filtered = bilateral_filter(spike(), options, Edge::kWrap);
  // Row 0: 1 + right + 2 left, offsets 2 and −2 (both 2 modulo 4) twice; rows ±2: those at their column
  // offsets once.
  const double sum = 1 + 3 * kBeside + 4 * kTwo + 2 * (kTwo + 2 * kKnight + 2 * kTwoDiagonal);
  EXPECT_NEAR(filtered(4, 4), 0.25 + 0.5 / sum, 1e-7);
  EXPECT_NEAR(filtered(3, 4), 0.25 + 0.5 * kBeside / sum, 1e-7);
  EXPECT_NEAR(filtered(5, 4), 0.25 + 0.5 * 2 * kBeside / sum, 1e-7);
  for (const auto& [x, y] : {std::pair{4, 3}, {4, 5}, {3, 3}, {5, 5}}) EXPECT_EQ(filtered(x, y), 0.25f);
}

TEST(Filter, WrapsOrStopsAtTheEdge) {
  Grid<float> heights(6, 6, 0);
  heights(0, 2) = 1;
  EXPECT_NEAR(bilateral_filter(heights, {1, kInfinity}, Edge::kWrap)(5, 2), kBeside / kSum, 1e-7);
  const Grid<float> open = bilateral_filter(heights, {1, kInfinity}, Edge::kOpen);
  EXPECT_EQ(open(5, 2), 0);
  const double open_sum = 1 + 3 * kBeside + 2 * kDiagonal + 3 * kTwo + 6 * kKnight + 2 * kTwoDiagonal;
  EXPECT_NEAR(open(0, 2), 1 / open_sum, 1e-6);  // one of the knight's moves more or less is 10⁻¹⁰
}

TEST(Filter, LeavesFlatAndTinyMapsAlone) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 5}, {5, 1}, {3, 2}}) {
    const Grid<float> flat(width, height, 0.3f);
    for (const FilterSum sum : {FilterSum::kAll, FilterSum::kMayaux2018})
      EXPECT_EQ(bilateral_filter(flat, {16, 0.2, sum}, Edge::kWrap).values, flat.values);
  }
}

TEST(Filter, RadiusZeroIsNoFilter) {
  EXPECT_EQ(bilateral_filter(spike(), {0, 0.2}, Edge::kWrap).values, spike().values);
}

TEST(Filter, StaysWithinTheHeightsAround) {
  Grid<float> heights(20, 20);
  for (size_t i = 0; i < heights.size(); ++i)
    heights[i] = static_cast<float>(unit_interval(mix_bits(1, 2, i)));
  for (const double radius : {0.01, 1.0, 5.0})
    for (const float value : bilateral_filter(heights, {radius, 0.2}, Edge::kWrap).values) {
      EXPECT_GE(value, 0);
      EXPECT_LE(value, 1);
    }
}

TEST(Filter, RefusesOptionsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [radius, tolerance] :
       {std::pair{-1.0, 0.2}, {17.0, 0.2}, {nan, 0.2}, {1.0, 0.0}, {1.0, -1.0}, {1.0, nan}})
    EXPECT_THROW(bilateral_filter(spike(), {radius, tolerance}, Edge::kWrap), InputError)
        << radius << " " << tolerance;
}

}  // namespace
}  // namespace hemibake
