#include "surface/surface.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.h"

namespace hemibake {
namespace {

Grid<float> rough(int width, int height) {
  Grid<float> heights(width, height);
  for (size_t i = 0; i < heights.size(); ++i) heights[i] = static_cast<float>(i * 7 % 5) / 4;
  return heights;
}

template <class Make>
void expect_refused(const Make& make, const std::string& words) {
  try {
    make();
    ADD_FAILURE() << "accepted, expected an error with: " << words;
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr(words));
  }
}

TEST(MakeSurface, ScalesHeightsAndTexels) {
  Grid<float> heights(4, 2, 0.25f);
  heights(1, 1) = 0.75f;
  const Surface surface = make_surface(heights, 2, 0.1, Edge::kWrap);
  EXPECT_EQ(surface.texel_size_m, 0.5);
  EXPECT_EQ(surface.heights_m(0, 0), 0);
  EXPECT_FLOAT_EQ(surface.heights_m(1, 1), 0.05f);
  EXPECT_FLOAT_EQ(static_cast<float>(height_range_m(surface)), 0.05f);
  EXPECT_EQ(surface.texel_count(), 8u);
}

TEST(MakeSurface, AnOffsetCostsNoPrecision) {
  Grid<float> heights(2, 1);
  heights[0] = 4096;
  heights[1] = 4096 + 0x1p-11f;  // the next float
  EXPECT_EQ(make_surface(heights, 1, 1, Edge::kWrap).heights_m[1], 0x1p-11f);
}

TEST(MakeSurface, TakesExtremeAmplitudes) {
  for (const double amplitude_m : {0.0, 1e-6, 1e3}) {
    const Surface surface = make_surface(rough(6, 5), 1, amplitude_m, Edge::kWrap);
    EXPECT_FLOAT_EQ(static_cast<float>(height_range_m(surface)), static_cast<float>(amplitude_m));
    for (const glm::vec3& normal : surface.normals.values) {
      EXPECT_NEAR(glm::length(normal), 1, 1e-6);
      EXPECT_GT(normal.z, 0);
    }
  }
}

TEST(MakeSurface, TakesThinMapsThatWrap) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 5}, {5, 1}})
    EXPECT_EQ(make_surface(rough(width, height), 1, 0.1, Edge::kWrap).normals.size(),
              static_cast<size_t>(width * height));
}

TEST(MakeSurface, RefusesMapsWithoutASurface) {
  expect_refused([] { make_surface(Grid<float>(), 1, 0.1, Edge::kWrap); }, "no texels");
  expect_refused([] { make_surface(rough(1, 5), 1, 0.1, Edge::kOpen); }, "1x5");
  expect_refused([] { make_surface(rough(5, 1), 1, 0.1, Edge::kOpen); }, "5x1");
}

TEST(MakeSurface, RefusesHeightsThatAreNotNumbersAndNamesTheTexel) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    Grid<float> heights = rough(4, 3);
    heights(3, 1) = bad;
    expect_refused([&] { make_surface(heights, 1, 0.1, Edge::kWrap); }, "texel 3,1");
  }
}

TEST(MakeSurface, RefusesLengthsThatAreNone) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double size_m : {0.0, -1.0, 1e-300, 1e300, nan, infinity})
    expect_refused([&] { make_surface(rough(4, 3), size_m, 0.1, Edge::kWrap); }, "size");
  for (const double amplitude_m : {-1e-9, -1.0, nan, infinity})
    expect_refused([&] { make_surface(rough(4, 3), 1, amplitude_m, Edge::kWrap); }, "amplitude");
}

TEST(MakeSurface, RefusesCliffsBeyondArithmetic) {
  Grid<float> heights = rough(4, 3);
  heights(0, 0) = std::numeric_limits<float>::max();
  heights(1, 0) = -std::numeric_limits<float>::max();
  expect_refused([&] { make_surface(heights, 1, 0.1, Edge::kWrap); }, "height range");
  expect_refused([&] { make_surface(heights, 1, std::numeric_limits<double>::max(), Edge::kWrap); },
                 "height range");
  expect_refused([&] { make_surface(rough(4, 3), 1e-12, 1e3, Edge::kWrap); }, "height range");
}

}  // namespace
}  // namespace hemibake
