#include "surface/normals.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>

#include "core/constants.h"
#include "core/error.h"
#include "support/maps.h"

namespace hemibake {
namespace {

constexpr double kFloatRounding =
    3e-7;  // of a unit vector's components and of heights of order 1 over a texel of 1

void expect_near(const glm::vec3& actual, const glm::dvec3& expected, double tolerance) {
  EXPECT_LT(glm::length(glm::dvec3(actual) - expected), tolerance)
      << actual.x << ", " << actual.y << ", " << actual.z << " instead of " << expected.x << ", "
      << expected.y << ", " << expected.z;
}

// Heights in metres over texels of 1 m.
template <class Height>
Surface surface_of(int width, int height, Edge edge, const Height& value) {
  Grid<float> heights(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) heights(x, y) = static_cast<float>(value(x, y));
  return make_surface(std::move(heights), std::max(width, height), 1, edge);
}

TEST(CentralDifferenceNormals, OfAPlaneAreItsNormalUpToOpenBorders) {
  const Surface plane = surface_of(6, 4, Edge::kOpen, [](int x, int y) { return 0.5 * x - 0.25 * y; });
  const auto normals = central_difference_normals(plane);
  for (size_t i = 0; i < normals.size(); ++i)
    expect_near(normals[i], glm::normalize(glm::dvec3(-0.5, 0.25, 1)), kFloatRounding);
}

TEST(CentralDifferenceNormals, OfAWaveWrap) {
  constexpr int kWidth = 12, kHeight = 8;
  const double wave_x = 2 * kPi / kWidth, wave_y = 2 * kPi / kHeight;
  const Surface waves = surface_of(kWidth, kHeight, Edge::kWrap, [&](int x, int y) {
    return std::sin(wave_x * x) + 0.5 * std::cos(wave_y * y);
  });
  const auto normals = central_difference_normals(waves);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      // (sin(a + d) − sin(a − d))/2 = cos a sin d, the central difference in closed form.
      const double slope_x = std::cos(wave_x * x) * std::sin(wave_x);
      const double slope_y = -0.5 * std::sin(wave_y * y) * std::sin(wave_y);
      expect_near(normals(x, y), glm::normalize(glm::dvec3(-slope_x, -slope_y, 1)), kFloatRounding);
    }
  }
}

TEST(CentralDifferenceNormals, OfOneTexelPointUp) {
  const Surface dot = surface_of(1, 1, Edge::kWrap, [](int, int) { return 3; });
  EXPECT_EQ(dot.normals[0], glm::vec3(0, 0, 1));
}

TEST(CentralDifferenceNormals, AreWhatMakeSurfaceStores) {
  const Surface rough = surface_of(9, 7, Edge::kWrap, [](int x, int y) { return (x * 7 + y * 3) % 5; });
  EXPECT_EQ(rough.normals.values, central_difference_normals(rough).values);
}

TEST(AngleWeightedNormals, OfARaisedCornerByHand) {
  // One cell, its far corner 1 m up: facet 0 is flat, facet 1 has slopes (1, 1).
  const Surface corner = surface_of(2, 2, Edge::kOpen, [](int x, int y) { return x * y; });
  const glm::dvec3 flat(0, 0, 1), slanted = glm::normalize(glm::dvec3(-1, -1, 1));
  const auto normals = angle_weighted_normals(corner);
  expect_near(normals(0, 0), flat, kFloatRounding);
  expect_near(normals(1, 1), slanted, kFloatRounding);
  // Facet 0 has 45° here; facet 1 is equilateral: all its sides are √2.
  expect_near(normals(1, 0), glm::normalize(kPi / 4 * flat + kPi / 3 * slanted), kFloatRounding);
  expect_near(normals(0, 1), glm::normalize(kPi / 4 * flat + kPi / 3 * slanted), kFloatRounding);
}

TEST(AngleWeightedNormals, OfARidgeAreSymmetricAndWrap) {
  const Surface ridges = surface_of(8, 4, Edge::kWrap, [](int x, int) { return std::min(x, 8 - x); });
  const auto normals = angle_weighted_normals(ridges);
  for (int y = 0; y < 4; ++y) {
    expect_near(normals(0, y), {0, 0, 1}, kFloatRounding);  // valley, across the border
    expect_near(normals(4, y), {0, 0, 1}, kFloatRounding);
    expect_near(normals(2, y), glm::normalize(glm::dvec3(-1, 0, 1)), kFloatRounding);
  }
}

Grid<glm::vec3> encoded(glm::dvec3 normal) { return Grid<glm::vec3>(1, 1, glm::vec3(0.5 * normal + 0.5)); }

TEST(AngleWeightedNormals, OfNeedlesTendToTheirLimit) {
  // The steeper a map, the less its height matters: (nx, ny) tends to a limit like 1 / amplitude.
  const Grid<glm::vec3> limit = angle_weighted_normals(white_noise_surface(16, 16, 1e8));
  for (const double amplitude_m : {1e6, 1e7, 1e10}) {
    const Grid<glm::vec3> normals = angle_weighted_normals(white_noise_surface(16, 16, amplitude_m));
    for (size_t i = 0; i < normals.size(); ++i) {
      EXPECT_GE(normals[i].z, 0) << amplitude_m;
      EXPECT_NEAR(glm::distance(glm::vec2(normals[i]), glm::vec2(limit[i])), 0, 1e-4) << amplitude_m;
    }
  }
}

TEST(DecodeNormalMap, TakesGreenAsTold) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.4, 0.8));
  expect_near(decode_normal_map(encoded(normal), {.y = NormalY::kDown})[0], normal, kFloatRounding);
  expect_near(decode_normal_map(encoded(normal), {.y = NormalY::kUp})[0], {normal.x, -normal.y, normal.z},
              kFloatRounding);
}

TEST(DecodeNormalMap, MakesUnitLength) {
  expect_near(decode_normal_map(encoded({0.1, 0.0, 0.2}), {.y = NormalY::kDown})[0],
              glm::normalize(glm::dvec3(0.1, 0, 0.2)), 10 * kFloatRounding);
}

TEST(DecodeNormalMap, RefusesWhatIsNoNormalAndNamesTheTexel) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinity = std::numeric_limits<float>::infinity();
  for (const glm::vec3 bad :
       {glm::vec3(0.5f, 0.5f, 0.5f), glm::vec3(0.5f, 0.5f, 0.0f), glm::vec3(1, 0.5f, 0.5f),
        glm::vec3(nan, 0.5f, 1), glm::vec3(0.5f, 0.5f, infinity)}) {
    Grid<glm::vec3> map(3, 2, glm::vec3(0.5f, 0.5f, 1));
    map(2, 1) = bad;
    try {
      decode_normal_map(map, {.y = NormalY::kUp});
      ADD_FAILURE() << "accepted " << bad.x << ", " << bad.y << ", " << bad.z;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("texel 2,1"));
    }
  }
}

TEST(DecodeNormalMap, TakesSignedNormalsOfUnitLengthBitForBit) {
  const glm::vec3 normal(glm::normalize(glm::dvec3(0.3, -0.4, 0.8)));
  EXPECT_EQ(decode_normal_map(Grid<glm::vec3>(1, 1, normal), {.encoding = NormalEncoding::kSigned})[0],
            normal);
  expect_near(
      decode_normal_map(Grid<glm::vec3>(1, 1, 3.0f * normal), {.encoding = NormalEncoding::kSigned})[0],
      normal, kFloatRounding);
}

TEST(DecodeNormalMap, MakesZAndUndoesSigns) {
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.4, 0.8));
  Grid<glm::vec3> two = encoded({-normal.x, normal.y, -1});
  expect_near(decode_normal_map(two, {.negated = {true, false, false}, .has_z = false})[0], normal,
              10 * kFloatRounding);
  // Codecs of two channels leave vectors a little too long.
  const glm::vec3 flat = decode_normal_map(encoded({0.8, 0.65, 0}), {.has_z = false})[0];
  EXPECT_GT(flat.z, 0);
}

TEST(CompareSlopes, IsOneForTheSameAndMinusOneForTheOtherSign) {
  const Surface bumps =
      surface_of(16, 12, Edge::kWrap, [](int x, int y) { return std::sin(x * 0.7) + std::cos(y * 1.3 + x); });
  Grid<glm::vec3> flipped = bumps.normals;
  for (glm::vec3& n : flipped.values) n.y = -n.y;
  const SlopeAgreement same = compare_slopes(bumps.normals, bumps.normals);
  EXPECT_NEAR(*same.x, 1, 1e-12);
  EXPECT_NEAR(*same.y, 1, 1e-12);
  EXPECT_NEAR(*same.slope_ratio, 1, 1e-12);
  EXPECT_NEAR(*compare_slopes(flipped, bumps.normals).y, -1, 1e-12);
  // Slopes three times as large are three times as large, however steep.
  Grid<glm::vec3> steeper = bumps.normals;
  for (glm::vec3& n : steeper.values) n = glm::normalize(glm::vec3(3 * n.x, 3 * n.y, n.z));
  EXPECT_NEAR(*compare_slopes(steeper, bumps.normals).slope_ratio, 3, 1e-5);
  const SlopeAgreement flat = compare_slopes(Grid<glm::vec3>(16, 12, glm::vec3(0, 0, 1)), bumps.normals);
  EXPECT_FALSE(flat.x || flat.y);
  EXPECT_EQ(*flat.slope_ratio, 0);
}

}  // namespace
}  // namespace hemibake
