#include "terrain/terrain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "support/brute_horizon.h"
#include "support/maps.h"
#include "terrain/horizon_tracer.h"

namespace hemibake {
namespace {

constexpr double kDegrees = 180 / kPi;

// A map of texels of 1 m with height(x, y) metres.
template <class Height>
Surface surface_of(int width, int height, Edge edge, const Height& height_m) {
  Grid<float> heights(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) heights(x, y) = static_cast<float>(height_m(x, y));
  return make_surface(std::move(heights), std::max(width, height), 1, edge);
}

TerrainOptions all_planes(int azimuths, int horizon_azimuths) {
  TerrainOptions options;
  options.svf = options.openness = options.negative_openness = true;
  options.azimuths = azimuths;
  options.horizon_azimuths = horizon_azimuths;
  return options;
}

// Compares with the independent program on every texel.
void expect_brute_force(const Surface& surface, const HorizonReach& reach) {
  for (const bool inverted : {false, true}) {
    const HorizonTracer tracer(surface, reach, inverted);
    for (const double degrees : {0.0, 37.3, 45.0, 90.0, 135.0, 163.2, 180.0, 225.0, 251.9, 270.0, 315.0}) {
      const double azimuth = degrees / kDegrees;
      const Grid<float> slopes = tracer.trace(azimuth);
      for (int y = 0; y < surface.height(); ++y)
        for (int x = 0; x < surface.width(); ++x) {
          const double expected = brute_horizon_slope(surface, x, y, std::sin(azimuth), -std::cos(azimuth),
                                                      inverted ? -1 : 1, reach.radius_m, reach.drop_per_m2);
          const double found = static_cast<double>(slopes(x, y));
          ASSERT_EQ(std::isinf(found), std::isinf(expected)) << x << ',' << y << " at " << degrees;
          // Heights in texels are rounded to float.
          if (std::isfinite(expected)) {
            ASSERT_NEAR(std::atan(found), std::atan(expected), 2e-6)
                << x << ',' << y << " at " << degrees << (inverted ? " inverted" : "");
          }
        }
    }
  }
}

TEST(Terrain, HorizonsAreThoseOfTheIndependentProgram) {
  expect_brute_force(white_noise_surface(37, 29, 0.3, Edge::kOpen), {});
  expect_brute_force(synthetic_surface(SyntheticKind::kTerrain, 48, 48, {}, {}, Edge::kOpen), {});
  expect_brute_force(white_noise_surface(2, 2, 1, Edge::kOpen), {});
}

TEST(Terrain, FarMapsAreSkippedInWindowsRightly) {
  // Three texels high, so that the independent program is fast, and long enough for windows of windows.
  const Surface strip = surface_of(700, 3, Edge::kOpen, [](int x, int y) {
    return 3 * std::sin(0.01 * x) + (x % 97 == 5 ? 4.0 : 0.0) + 0.1 * ((x * 7 + y * 5) % 11);
  });
  expect_brute_force(strip, {});
}

TEST(Terrain, RadiusAndCurvatureAreThoseOfTheIndependentProgram) {
  const Surface surface = synthetic_surface(SyntheticKind::kTerrain, 40, 32, 0.3, {}, Edge::kOpen);
  HorizonReach reach;
  reach.radius_m = 0.2;
  expect_brute_force(surface, reach);
  reach.drop_per_m2 = 2;
  expect_brute_force(surface, reach);
  reach.radius_m = HUGE_VAL;
  expect_brute_force(surface, reach);
}

TEST(Terrain, FlatGroundHasAllTheSky) {
  for (const Edge edge : {Edge::kWrap, Edge::kGround}) {
    const Surface flat = surface_of(8, 6, edge, [](int, int) { return 5; });
    const TerrainPlanes planes = make_terrain(flat, all_planes(16, 4));
    ASSERT_EQ(planes.horizons.size(), 4u);
    for (size_t i = 0; i < flat.heights_m.size(); ++i) {
      EXPECT_EQ(planes.svf[i], 1);
      EXPECT_EQ(planes.openness[i], 90);
      EXPECT_EQ(planes.negative_openness[i], 90);
      for (const auto& horizon : planes.horizons) EXPECT_EQ(horizon[i], 0);
    }
  }
}

TEST(Terrain, PlaneIsItsSlopeUphillAndLevelDownhill) {
  // Rises by ½ texel along x (east).
  const Surface plane = surface_of(33, 33, Edge::kGround, [](int x, int) { return 0.5 * x; });
  const TerrainPlanes planes = make_terrain(plane, all_planes(720, 36));
  const double slope = std::atan(0.5) * kDegrees;
  const int x = 10, y = 16;
  EXPECT_NEAR(planes.horizons[9](x, y), slope, 1e-5);  // east
  EXPECT_NEAR(planes.horizons[27](x, y), 0, 1e-5);     // west: the ground beyond is level
  EXPECT_NEAR(planes.horizons[0](x, y), 0, 1e-5);      // north, along the contour
  EXPECT_NEAR(planes.horizons[6](x, y), std::atan(0.5 * std::sin(kPi / 3)) * kDegrees, 1e-5);
  // Mean over azimuths of 1 − sin atan(½ sin a) over the uphill half; ∫₀^π b sin a / √(1 + b² sin² a) da =
  // 2 asin(b / √(1 + b²)) = 2 atan b.
  EXPECT_NEAR(planes.svf(x, y), 1 - std::atan(0.5) / kPi, 1e-5);
}

TEST(Terrain, WallAndConeHaveTheirAngles) {
  const int wall_x = 20;
  const Surface wall = surface_of(41, 41, Edge::kGround, [&](int x, int) { return x >= wall_x ? 6 : 0; });
  const TerrainPlanes of_wall = make_terrain(wall, all_planes(16, 8));
  EXPECT_NEAR(of_wall.horizons[2](12, 20), std::atan(6.0 / 8) * kDegrees, 1e-5);
  EXPECT_NEAR(of_wall.horizons[1](12, 20), std::atan(6.0 / (8 * std::sqrt(2))) * kDegrees, 1e-5);
  EXPECT_NEAR(of_wall.horizons[6](12, 20), 0, 1e-5);
  // From the tip of a cone every azimuth falls by its slope, up to the facets' own; upside down it is a pit.
  const Surface cone =
      surface_of(65, 65, Edge::kOpen, [](int x, int y) { return 32 - std::hypot(x - 32, y - 32); });
  const TerrainPlanes of_cone = make_terrain(cone, all_planes(64, 4));
  EXPECT_NEAR(of_cone.openness(32, 32), 135, 0.3);
  double below = 0;  // of the cone's triangles, which are steeper than the cone near its tip
  for (int k = 0; k < 64; ++k) {
    const double azimuth = 2 * kPi * (k + 0.5) / 64;
    below += 90 - kDegrees *
                      std::atan(brute_horizon_slope(cone, 32, 32, std::sin(azimuth), -std::cos(azimuth), -1));
  }
  EXPECT_NEAR(of_cone.negative_openness(32, 32), below / 64, 1e-4);
  EXPECT_NEAR(of_cone.horizons[1](32, 32), -45, 1e-4);
  EXPECT_EQ(of_cone.svf(32, 32), 1);
}

TEST(Terrain, GroundBeyondTheBorderLimitsOpennessWithinARadius) {
  const Surface plane = surface_of(21, 21, Edge::kGround, [](int x, int) { return x; });
  TerrainOptions options = all_planes(4, 4);
  options.radius_m = 100;
  const TerrainPlanes planes = make_terrain(plane, options);
  // 10 texels west of the middle the ground begins, 10 lower; it is seen up to 100.
  EXPECT_NEAR(planes.horizons[3](10, 10), -std::atan(0.1) * kDegrees, 1e-5);
}

TEST(Terrain, CurvatureLowersTheHorizonByItsFormula) {
  // Texels of 1 km; a wall of 500 m 50 km away.
  Grid<float> heights(64, 3);
  for (int y = 0; y < 3; ++y) heights(60, y) = 500;
  const Surface far_wall = make_surface(std::move(heights), 64e3, 1, Edge::kGround);
  TerrainOptions options = all_planes(4, 4);
  options.curvature = true;
  const TerrainPlanes curved = make_terrain(far_wall, options);
  const double drop = 50e3 * 50e3 * 0.87 / (2 * 6371e3);  // 171 m
  EXPECT_NEAR(curved.horizons[1](10, 1), std::atan((500 - drop) / 50e3) * kDegrees, 1e-5);
  // From the top of the wall, level ground dips: at r = √(h / c) the slope is −2 √(h c), c = .87 / 2R.
  EXPECT_NEAR(curved.horizons[3](60, 1), -std::atan(2 * std::sqrt(500 * 0.87 / (2 * 6371e3))) * kDegrees,
              1e-3);
}

TEST(Terrain, WrappingMapsRepeat) {
  // A ridge every 16 texels, 4 high: from the middle between two of them the same both ways.
  const Surface ridges = surface_of(16, 16, Edge::kWrap, [](int x, int) { return x == 0 ? 4 : 0; });
  const TerrainPlanes planes = make_terrain(ridges, all_planes(64, 4));
  EXPECT_NEAR(planes.horizons[1](8, 3), std::atan(0.5) * kDegrees, 1e-5);
  EXPECT_NEAR(planes.horizons[3](8, 3), std::atan(0.5) * kDegrees, 1e-5);
  EXPECT_NEAR(planes.horizons[1](15, 3), std::atan(4.0) * kDegrees, 1e-5);
  EXPECT_NEAR(planes.horizons[0](8, 3), 0, 1e-5);
}

TEST(Terrain, ExtremesStayFiniteAndInRange) {
  for (const double amplitude : {0.0, 1e-6, 1e3})
    for (const Edge edge : {Edge::kWrap, Edge::kOpen, Edge::kGround})
      for (const auto& [width, height] : {std::pair{1, 1}, {1, 37}, {2, 2}, {33, 17}}) {
        if (edge != Edge::kWrap && (width < 2 || height < 2)) continue;
        const TerrainPlanes planes =
            make_terrain(white_noise_surface(width, height, amplitude, edge), all_planes(8, 8));
        for (size_t i = 0; i < planes.svf.size(); ++i) {
          EXPECT_TRUE(planes.svf[i] >= 0 && planes.svf[i] <= 1);
          EXPECT_TRUE(planes.openness[i] >= 0 && planes.openness[i] <= 180);
          EXPECT_TRUE(planes.negative_openness[i] >= 0 && planes.negative_openness[i] <= 180);
          for (const auto& horizon : planes.horizons) EXPECT_TRUE(std::abs(horizon[i]) <= 90);
        }
      }
}

}  // namespace
}  // namespace hemibake
