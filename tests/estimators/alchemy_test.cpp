#include "estimators/alchemy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/constants.h"
#include "support/maps.h"

namespace hemibake {
namespace {

TEST(Alchemy, FlatGroundHasNoObscurance) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = synthetic_surface(SyntheticKind::kFlat, 48, 40, 0.1, {}, edge);
    const AlchemyOptions options;
    for (const GeometryBuffer& buffer : {orthographic_buffer(surface, 1), perspective_buffer(surface, {})}) {
      const Grid<double> obscurance = alchemy_obscurance(buffer, options, 0.2);
      for (const double s : obscurance.values) ASSERT_EQ(s, 0);
    }
  }
}

// The bias keeps a plane clear also where its depths are rounded: a millimetre of waves seen from a metre.
TEST(Alchemy, BiasIsAThresholdPerMetreOfDepth) {
  const Surface surface = white_noise_surface(32, 32, 4e-4);
  AlchemyOptions options;
  const GeometryBuffer buffer = orthographic_buffer(surface, 1);
  double with_bias = 0, without = 0;
  for (const double s : alchemy_obscurance(buffer, options, 0.2).values) with_bias += s;
  options.bias = 0;
  for (const double s : alchemy_obscurance(buffer, options, 0.2).values) without += s;
  EXPECT_LT(with_bias, 0.2 * without);
}

// The notes' sum at some pixels, written out again.
TEST(Alchemy, IsThePapersSum) {
  const Surface surface = white_noise_surface(40, 32, 0.15);
  AlchemyOptions options;
  options.taps = 11;
  const double radius = 0.25, c = 0.1 * radius, t = surface.texel_size_m;
  const Grid<double> obscurance = alchemy_obscurance(orthographic_buffer(surface, 1), options, radius);
  const double top = height_range_m(surface);
  for (const auto& [x, y] : {std::pair{0, 0}, {39, 31}, {13, 22}, {25, 7}}) {
    const glm::dvec3 p(x * t, y * t, surface.heights_m(x, y)), n(surface.normals(x, y));
    double sum = 0;
    for (int i = 0; i < 11; ++i) {
      const double alpha = (i + 0.5) / 11, h = alpha * radius / t;
      const double theta = 2 * kPi * alpha * (7 * 11 / 9.0) + ((30 * x) ^ y) + 10 * x * y;
      const int tap_x = x + static_cast<int>(std::lround(h * std::cos(theta)));
      const int tap_y = y + static_cast<int>(std::lround(h * std::sin(theta)));
      const double z = surface.heights_m(wrap_index(tap_x, 40), wrap_index(tap_y, 32));
      const glm::dvec3 w = glm::dvec3(tap_x * t, tap_y * t, z) - p;
      if (glm::length(w) > radius) continue;
      sum += std::max(0.0, glm::dot(n, w) - 1e-3 * (1 + top - z)) / std::max(c * c, glm::dot(w, w));
    }
    EXPECT_NEAR(obscurance(x, y), 2 * kPi * c / 11 * sum, 1e-12);
  }
}

// Star discrepancy of points in the unit square: the worst error of the share of points in any box at the
// origin.
double star_discrepancy(const std::vector<glm::dvec2>& points) {
  std::vector<double> xs{1}, ys{1};
  for (const glm::dvec2& p : points) xs.push_back(p.x), ys.push_back(p.y);
  double worst = 0;
  for (const double x : xs)
    for (const double y : ys) {
      double open = 0, closed = 0;
      for (const glm::dvec2& p : points) {
        open += p.x < x && p.y < y;
        closed += p.x <= x && p.y <= y;
      }
      const double n = static_cast<double>(points.size());
      worst = std::max({worst, x * y - open / n, closed / n - x * y});
    }
  return worst;
}

// The spiral is uniform in radius and angle (not in area: near taps are denser). 16 points.
TEST(Alchemy, SpiralCoversTheDisk) {
  constexpr int kTaps = 16;
  std::vector<glm::dvec2> spiral;
  std::vector<int> octants(8, 0);
  for (int i = 0; i < kTaps; ++i) {
    const glm::dvec2 tap = spiral_tap(i, kTaps, 0);
    const double turn = std::atan2(tap.y, tap.x) / (2 * kPi);
    spiral.emplace_back(glm::length(tap), turn - std::floor(turn));
    ++octants[static_cast<size_t>(8 * spiral.back().y)];
  }
  double random_mean = 0;
  constexpr int kTrials = 200;
  for (uint64_t trial = 0; trial < kTrials; ++trial) {
    std::vector<glm::dvec2> random;
    for (uint64_t i = 0; i < kTaps; ++i)
      random.emplace_back(unit_interval(mix_bits(trial, 0, i)), unit_interval(mix_bits(trial, 1, i)));
    random_mean += star_discrepancy(random) / kTrials;
  }
  const double of_spiral = star_discrepancy(spiral);
  std::printf("star discrepancy of 16 taps: spiral %.3f, random %.3f\n", of_spiral, random_mean);
  EXPECT_LT(of_spiral, 0.6 * random_mean);
  for (const int taps : octants) EXPECT_GE(taps, 1);  // no eighth of the circle without a tap
}

TEST(Alchemy, PerspectiveShowsTheSurface) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 48, 48, 0.2, {}, Edge::kOpen);
  const PerspectiveCamera camera{.pixels = 120};
  const CameraView view = camera_view(surface, camera);
  const GeometryBuffer buffer = perspective_buffer(surface, camera);
  int shown = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 120; ++x) {
      const auto pixel = buffer.read(x, y);
      if (!pixel) continue;
      ++shown;
      const glm::dvec3 projected = view.project(pixel->position_m);
      ASSERT_NEAR(projected.x, x + 0.5, 1e-6);
      ASSERT_NEAR(projected.y, y + 0.5, 1e-6);
      ASSERT_NEAR(projected.z, pixel->depth_m, 1e-9);
      // On the triangle below: within the heights of its cell.
      const int i = static_cast<int>(pixel->position_m.x / surface.texel_size_m - 0.5);
      const int j = static_cast<int>(pixel->position_m.y / surface.texel_size_m - 0.5);
      float low = 1e9f, high = -1e9f;
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        low = std::min(low, surface.heights_m(std::min(i + dx, 47), std::min(j + dy, 47)));
        high = std::max(high, surface.heights_m(std::min(i + dx, 47), std::min(j + dy, 47)));
      }
      ASSERT_GE(pixel->position_m.z, static_cast<double>(low) - 1e-6);
      ASSERT_LE(pixel->position_m.z, static_cast<double>(high) + 1e-6);
    }
  EXPECT_GT(shown, 120 * 120 / 4);
  AlchemyOptions options;
  options.projection = Projection::kPerspective;
  options.camera = camera;
  const Estimate estimate = estimate_alchemy(surface, options);
  int known = 0;
  for (const uint8_t k : estimate.known.values) known += k;
  EXPECT_GT(known, 48 * 48 * 9 / 10);
}

// A step in depth with another AO on either side: both passes leave it alone, while noise on either side is
// smoothed.
TEST(BilateralBlur, KeepsAStepEdge) {
  const Surface surface = synthetic_surface(SyntheticKind::kStep, 32, 32, 0.5, {}, Edge::kOpen);
  GeometryBuffer buffer = orthographic_buffer(surface, 1);
  for (GeometryPixel& pixel : buffer.pixels.values) pixel.normal = {0, 0, 1};
  Grid<float> image(32, 32), flat(32, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      flat(x, y) = surface.heights_m(x, y) > 0 ? 0.9f : 0.3f;
      image(x, y) = flat(x, y) + ((x + y) % 2 ? 0.1f : -0.1f);
    }
  const Grid<float> rows = bilateral_blur_pass(image, buffer, 4, 1e-3, BlurAxis::kRows);
  const Grid<float> both = bilateral_blur_pass(rows, buffer, 4, 1e-3, BlurAxis::kColumns);
  double worst = 0, worst_inside = 0;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const double error = std::abs(static_cast<double>(both(x, y) - flat(x, y)));
      worst = std::max(worst, error);
      if (y >= 4 && y < 28 && (x - 16 >= 4 || 15 - x >= 4) && x >= 4 && x < 28)
        worst_inside = std::max(worst_inside, error);
    }
  std::printf("blur of noise of 0.1 beside a step of 0.6: worst error %.4f, inside %.4f\n", worst,
              worst_inside);
  EXPECT_LT(worst, 0.05);  // a mean across the step would be off by 0.3
  EXPECT_LT(worst_inside, 0.02);

  // Facing away counts as little as lying behind: a ridge of two normals at right angles.
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      buffer.pixels(x, y) = {{0, 0, 0}, x < 16 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1), 1};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) image(x, y) = x < 16 ? 0.2f : 0.8f;
  const Grid<float> ridge = bilateral_blur_pass(image, buffer, 4, 1e-3, BlurAxis::kRows);
  for (size_t i = 0; i < image.size(); ++i) ASSERT_NEAR(ridge[i], image[i], 1e-6);
}

TEST(Alchemy, GivesEveryStageOfTheBlur) {
  const Surface surface = white_noise_surface(24, 24, 0.1);
  AlchemyOptions options;
  const GeometryBuffer buffer = orthographic_buffer(surface, 1);
  const AlchemyImages images = alchemy_images(buffer, options, 0.2);
  EXPECT_NE(images.raw.values, images.blurred_rows.values);
  EXPECT_NE(images.blurred_rows.values, images.blurred.values);
  options.blur = BlurPasses::kNone;
  EXPECT_EQ(alchemy_images(buffer, options, 0.2).blurred.values, images.raw.values);
  options.blur = BlurPasses::kRows;
  EXPECT_EQ(alchemy_images(buffer, options, 0.2).blurred.values, images.blurred_rows.values);
  // (1 − sS)₊^k
  const Grid<double> s = alchemy_obscurance(buffer, options, 0.2);
  options.scale = 0.7;
  options.contrast = 2;
  const AlchemyImages contrast = alchemy_images(buffer, options, 0.2);
  for (size_t i = 0; i < s.size(); ++i)
    ASSERT_NEAR(contrast.raw[i], std::pow(std::max(0.0, 1 - 0.7 * s[i]), 2), 1e-6);
}

}  // namespace
}  // namespace hemibake
