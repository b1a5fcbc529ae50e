#include "trade/resample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "support/maps.h"
#include "surface/normals.h"

namespace hemibake {
namespace {

TEST(Resample, HalfIsTheMeanOfFour) {
  const Surface surface = white_noise_surface(8, 6, 0.3);
  const Surface half = resample_surface(surface, 0.5);
  ASSERT_EQ(half.width(), 4);
  ASSERT_EQ(half.height(), 3);
  EXPECT_DOUBLE_EQ(half.texel_size_m, 2 * surface.texel_size_m);
  const auto mean_of_four = [&](int x, int y) {
    return 0.25f * (surface.heights_m(2 * x, 2 * y) + surface.heights_m(2 * x + 1, 2 * y) +
                    surface.heights_m(2 * x, 2 * y + 1) + surface.heights_m(2 * x + 1, 2 * y + 1));
  };
  // Heights count from the lowest texel, so only differences are the same.
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_NEAR(half.heights_m(x, y) - half.heights_m(0, 0), mean_of_four(x, y) - mean_of_four(0, 0), 1e-6);
}

TEST(Resample, KeepsPlanesAndTheirNormals) {
  Grid<float> heights(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) heights(x, y) = 0.25f * static_cast<float>(x) + 0.5f * static_cast<float>(y);
  const Surface surface = make_surface(heights, 16, 1, Edge::kOpen);
  for (const double factor : {0.5, 2.0}) {
    const Surface other = resample_surface(surface, factor);
    const int middle = other.width() / 2;
    EXPECT_NEAR(other.normals(middle, middle).x, surface.normals(8, 8).x, 1e-5);
    EXPECT_NEAR(other.normals(middle, middle).y, surface.normals(8, 8).y, 1e-5);
  }
}

TEST(Resample, KeepsNormalsThatAreNotTheHeights) {
  Surface surface = white_noise_surface(8, 8, 0.3);
  const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, -0.2f, 1));
  surface.normals = Grid<glm::vec3>(8, 8, tilted);
  const Surface twice = resample_surface(surface, 2);
  for (const glm::vec3& normal : twice.normals.values) EXPECT_NEAR(glm::dot(normal, tilted), 1, 1e-6);
  EXPECT_NE(central_difference_normals(twice).values, twice.normals.values);
}

TEST(Resample, WavesComeBackWithoutASeam) {
  constexpr int kTexels = 64;
  Grid<float> wave(kTexels, kTexels);
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x)
      wave(x, y) = static_cast<float>(std::cos(2 * kPi * (x + y + 1.0) / kTexels));
  const Grid<float> back = resample_plane(resample_plane(wave, kTexels / 2, kTexels / 2, Edge::kWrap),
                                          kTexels, kTexels, Edge::kWrap);
  // Linear interpolation of a wave over spacing h errs by at most h²/8 times its second derivative: with two
  // axes, spacings of one and two texels: (1 + 4)/8 · 2 · (2π/64)² = 0.012.
  for (size_t i = 0; i < wave.size(); ++i) EXPECT_NEAR(back[i], wave[i], 0.012);
}

TEST(Resample, HalvesOnlyEvenSides) {
  EXPECT_TRUE(can_halve(white_noise_surface(8, 6, 0.1)));
  EXPECT_FALSE(can_halve(white_noise_surface(8, 5, 0.1)));
  EXPECT_TRUE(can_halve(white_noise_surface(2, 2, 0.1)));
  EXPECT_FALSE(can_halve(white_noise_surface(2, 2, 0.1, Edge::kOpen)));
  EXPECT_FALSE(can_halve(white_noise_surface(1, 1, 0.1)));
}

}  // namespace
}  // namespace hemibake
