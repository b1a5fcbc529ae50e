// Exposure, colours, figures and the camera.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/color.h"
#include "core/constants.h"
#include "io/picture_text.h"
#include "pictures/camera.h"
#include "pictures/color_map.h"
#include "pictures/figure.h"
#include "support/maps.h"

namespace hemibake {
namespace {

TEST(Tone, SrgbCurve) {
  for (const double value : {0.0, 0.001, 0.0031308, 0.18, 0.5, 1.0})
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(value)), value, 1e-7);
  EXPECT_NEAR(srgb_from_linear(0.5), 0.7353569830524495, 1e-12);
}

TEST(Tone, WhatDoesNotFitIsCounted) {
  Grid<glm::vec3> light(4, 1);
  light[0] = {0.5f, 0.5f, 0.5f};
  light[1] = {0.6f, 0, 0};
  light[2] = {-0.1f, 0, 2};
  Clipping clipping;
  const Grid<glm::vec3> shown = encode_srgb(light, 1, clipping);
  EXPECT_EQ(clipping.above_white, 2u);
  EXPECT_EQ(clipping.below_black, 1u);
  EXPECT_EQ(shown[0].x, 1);
  EXPECT_EQ(shown[2].x, 0);
}

TEST(Tone, ExposureLeavesAThousandthAboveWhite) {
  Grid<glm::vec3> light(100, 20);
  for (size_t i = 0; i < light.size(); ++i) light[i] = glm::vec3(static_cast<float>(i) / 100000, 0, 0);
  light[7].y = 1e6f;
  const std::array pictures = {&light};
  const double exposure = exposure_for(pictures);
  Clipping clipping;
  encode_srgb(light, exposure, clipping);
  EXPECT_LE(clipping.above_white, 2u);
  clipping = {};
  encode_srgb(light, exposure + 0.25, clipping);
  EXPECT_GT(clipping.above_white, 2u) << "a quarter of a stop more would be too much";
  const Grid<glm::vec3> black(2, 2), nothing;
  const std::array dark = {&black, &nothing};
  EXPECT_EQ(exposure_for(dark), 0);
}

TEST(ColorMap, OklabBackAndForth) {
  const glm::dvec3 color(0.2, 0.7, 0.4), back = linear_from_oklab(oklab_from_linear(color));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c], color[c], 1e-6);  // its matrices have ten digits
  EXPECT_NEAR(oklab_from_linear(glm::dvec3(1)).x, 1, 1e-6);
}

TEST(ColorMap, LightnessIsTheNumber) {
  for (int i = 0; i <= 100; ++i) {
    const double value = i / 100.0;
    EXPECT_NEAR(oklab_from_linear(sequential_color(value)).x, 0.2 + 0.75 * value, 1e-5) << value;
    const double plus = oklab_from_linear(diverging_color(value)).x;
    EXPECT_NEAR(plus, oklab_from_linear(diverging_color(-value)).x, 1e-5) << value;
    EXPECT_NEAR(plus, 0.97 - 0.52 * value, 1e-5) << value;
  }
  EXPECT_GT(diverging_color(1).x, diverging_color(1).z) << "too bright is red";
  EXPECT_GT(diverging_color(-1).z, diverging_color(-1).x) << "too dark is blue";
}

TEST(ColorMap, RoundScale) {
  EXPECT_EQ(round_scale(0), 1);
  EXPECT_DOUBLE_EQ(round_scale(0.02), 0.02);
  EXPECT_DOUBLE_EQ(round_scale(0.021), 0.025);
  EXPECT_DOUBLE_EQ(round_scale(9e-9), 1e-8);
}

TEST(Figure, ScalingKeepsTheMean) {
  Grid<glm::vec3> picture(8, 6);
  for (size_t i = 0; i < picture.size(); ++i) picture[i] = glm::vec3(static_cast<float>(i));
  const Grid<glm::vec3> small = scaled(picture, 4), large = scaled(picture, 31);
  EXPECT_EQ(small.width, 4);
  EXPECT_EQ(small.height, 3);
  EXPECT_EQ(small(0, 0).x, (0 + 1 + 8 + 9) / 4.0f);
  const Grid<glm::vec3> third = scaled(picture, 3);  // 8 columns to 3: the first has 0, 1 and two thirds of 2
  EXPECT_EQ(third.height, 2);
  EXPECT_NEAR(third(0, 0).x, (0 + 1 + 2 * 2 / 3.0) / (8 / 3.0) + 8, 1e-5);
  EXPECT_EQ(large.width, 24);
  EXPECT_EQ(large(23, 17).x, picture(7, 5).x);
}

TEST(Figure, ColorsOfAScaleAndItsClipping) {
  Grid<float> values(3, 1);
  values[0] = -2;
  values[1] = 0;
  values[2] = 1;
  size_t clipped = 0;
  const Grid<glm::vec3> shown = colored(values, {diverging_color, -1, 1, -1, "label"}, clipped);
  EXPECT_EQ(clipped, 1u);
  EXPECT_NEAR(shown[1].x, shown[1].z, 0.02) << "0 is near white";
  const std::vector<Panel> row{{shown, "caption"}, {shown, ""}};
  const Grid<glm::vec3> figure = make_figure({&row, 1});
  EXPECT_GE(figure.width, 6);
  if (!has_font()) GTEST_SKIP() << "no font here";
  EXPECT_GT(text_size("caption", 15).width, text_size("cap", 15).width);
}

// Straight from above a flat map is a picture of itself.
TEST(Camera, FromAboveTheMapIsItsOwnPicture) {
  const Surface surface = make_surface(Grid<float>(16, 16), 1, 0, Edge::kOpen);
  Grid<glm::vec3> texels(16, 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) texels(x, y) = glm::vec3(x, y, 1);
  CameraOptions options;
  options.azimuth_rad = kPi;
  options.elevation_rad = kPi / 2;
  options.width = options.height = 64;
  options.span = 2;  // 32 texels across
  const View view = trace_view(surface, options);
  const Grid<glm::vec3> picture = paint_view(surface, view, texels, glm::vec3(-1));
  for (int y = 0; y < 64; y += 3)
    for (int x = 0; x < 64; x += 3) {
      const double at_x = 7.5 + (x + 0.5 - 32) / 2, at_y = 7.5 + (y + 0.5 - 32) / 2;
      const double inside = std::min({at_x, at_y, 15 - at_x, 15 - at_y});
      if (inside < -0.3) {
        EXPECT_EQ(picture(x, y).z, -1) << x << ' ' << y;
      }
      if (inside < 0.3) continue;
      EXPECT_NEAR(picture(x, y).x, at_x, 1e-4);
      EXPECT_NEAR(picture(x, y).y, at_y, 1e-4);
    }
}

// From the side the map repeats for ever, and no pixel is empty; its near side is at the bottom.
TEST(Camera, WrappingMapFillsThePicture) {
  const Surface surface = white_noise_surface(16, 12, 0.2);
  CameraOptions options;
  options.azimuth_rad = kPi;  // below the picture of the map
  options.width = 40;
  options.height = 30;
  const View view = trace_view(surface, options);
  for (const ViewSample& sample : view.samples) {
    ASSERT_NE(sample.facet, ViewSample::kNothing);
    ASSERT_GE(std::min(sample.u, sample.v), -1e-6f);
    ASSERT_LE(sample.u + sample.v, 1 + 1e-6f);
  }
  EXPECT_TRUE(trace_view(surface, options).samples[5].u == view.samples[5].u);
}

TEST(Camera, ExtremesAreSeen) {
  for (const double amplitude : {0.0, 1e-6, 1e3}) {
    const Surface surface = white_noise_surface(8, 8, amplitude);
    CameraOptions options;
    options.width = options.height = 8;
    size_t seen = 0;
    for (const ViewSample& sample : trace_view(surface, options).samples)
      seen += sample.facet != ViewSample::kNothing;
    EXPECT_EQ(seen, size_t{8 * 8 * 9}) << amplitude;
  }
  const Surface one = make_surface(Grid<float>(1, 1), 1, 1, Edge::kWrap);
  CameraOptions small;
  small.width = small.height = 4;
  EXPECT_NE(trace_view(one, small).samples[0].facet, ViewSample::kNothing);
}

}  // namespace
}  // namespace hemibake
