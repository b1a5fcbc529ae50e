// Holes of a height map, and texels that are not square.
#include "surface/holes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "surface/square_texels.h"

namespace hemibake {
namespace {

// A harmonic function: its membrane is itself.
double saddle(int x, int y) { return 0.3 + 0.01 * x - 0.02 * y + 0.001 * (x * x - y * y) + 0.002 * x * y; }

Grid<float> harmonic_map(int width, int height) {
  Grid<float> map(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) map(x, y) = static_cast<float>(saddle(x, y));
  return map;
}

TEST(Holes, AHarmonicSurfaceGoesOnThroughThem) {
  Grid<float> map = harmonic_map(40, 30);
  Grid<uint8_t> holes(40, 30, 0);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x)
      if (std::hypot(x - 20.0, y - 14.0) < 11 || (x == 3 && y == 4) || (x > 33 && x < 38 && y > 2 && y < 28))
        holes(x, y) = 1, map(x, y) = -9999;
  const size_t count = static_cast<size_t>(std::count(holes.values.begin(), holes.values.end(), 1));
  EXPECT_EQ(fill_holes(holes, Edge::kOpen, map), count);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) EXPECT_NEAR(map(x, y), saddle(x, y), 1e-5) << x << "," << y;
}

TEST(Holes, NoValueLiesBeyondTheRim) {
  Grid<float> map(16, 16, 2);
  Grid<uint8_t> holes(16, 16, 0);
  for (int y = 0; y < 16; ++y) holes(0, y) = holes(1, y) = 1;  // at the border
  map(2, 5) = 3;
  for (const Edge edge : {Edge::kOpen, Edge::kWrap}) {
    Grid<float> filled = map;
    fill_holes(holes, edge, filled);
    for (int y = 0; y < 16; ++y) {
      EXPECT_GE(filled(0, y), 2);
      EXPECT_LE(filled(0, y), 3);
    }
    EXPECT_GT(filled(1, 5), filled(0, 5));
  }
}

TEST(Holes, AlikeHeightsStayAlikeAndOneTexelIsEnough) {
  Grid<float> map(5, 4, 7.25f);
  Grid<uint8_t> holes(5, 4, 1);
  holes(2, 1) = 0;
  EXPECT_EQ(fill_holes(holes, Edge::kWrap, map), 19u);
  EXPECT_THAT(map.values, testing::Each(7.25f));
  EXPECT_EQ(fill_holes(Grid<uint8_t>(), Edge::kWrap, map), 0u);
  EXPECT_THROW(fill_holes(Grid<uint8_t>(5, 4, 1), Edge::kWrap, map), InputError);
}

TEST(SquareTexels, ARampStaysARamp) {
  const Grid<float> map = [] {
    Grid<float> ramp(7, 5);
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 7; ++x) ramp(x, y) = static_cast<float>(10 * x + 30 * 2 * y);
    return ramp;
  }();
  const SquareTexels square = make_texels_square(map, 10, 30, Edge::kGround);
  ASSERT_EQ(square.heights.width, 7);
  ASSERT_EQ(square.heights.height, 13);
  EXPECT_EQ(square.texel_m, 10);
  for (int y = 0; y < 13; ++y)
    for (int x = 0; x < 7; ++x) EXPECT_FLOAT_EQ(square.heights(x, y), static_cast<float>(10 * x + 20 * y));
}

TEST(SquareTexels, AWrappingMapKeepsItsPeriodAndItsTexelsAtOddRatios) {
  Grid<float> map(4, 6);
  for (size_t i = 0; i < map.size(); ++i) map[i] = static_cast<float>(std::sin(1.7 * static_cast<double>(i)));
  const SquareTexels square = make_texels_square(map, 3, 1, Edge::kWrap);
  ASSERT_EQ(square.heights.width, 12);
  ASSERT_EQ(square.heights.height, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 4; ++x) {
      EXPECT_FLOAT_EQ(square.heights(3 * x + 1, y), map(x, y));
      const float next = map((x + 1) % 4, y);
      EXPECT_NEAR(square.heights((3 * x + 2) % 12, y), map(x, y) + (next - map(x, y)) / 3, 1e-6);
    }
}

TEST(SquareTexels, RefusesWhatIsFarFromSquare) {
  EXPECT_THROW(make_texels_square(Grid<float>(4, 4, 0.0f), 1, 1000, Edge::kWrap), InputError);
  EXPECT_THROW(make_texels_square(Grid<float>(4000000, 1, 0.0f), 100, 1, Edge::kWrap), InputError);
  EXPECT_EQ(make_texels_square(Grid<float>(4, 4, 1.0f), 2, 2, Edge::kOpen).heights.size(), 16u);
  EXPECT_EQ(make_texels_square(Grid<float>(1, 1, 1.0f), 2, 1, Edge::kWrap).heights.size(), 2u);
}

}  // namespace
}  // namespace hemibake
