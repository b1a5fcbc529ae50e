#include "surface/synthetic/analytic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "surface/facets.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

constexpr double kDegree = kPi / 180;
constexpr double kHalfUlp = 0x1p-25;  // of a float height below 1

SyntheticMap make(SyntheticKind kind, int width, int height, std::optional<double> angle_rad = {}) {
  return synthesize(kind, {.width = width, .height = height, .seed = 1, .angle_rad = angle_rad});
}

TEST(Bowl, HeightsLieOnTheSphereAndThePlane) {
  for (const double angle : {10 * kDegree, 60 * kDegree, 89 * kDegree}) {
    for (const auto& [width, height] : {std::pair{256, 256}, {200, 101}}) {
      const SyntheticMap map = make(SyntheticKind::kBowl, width, height, angle);
      const BowlGeometry bowl = bowl_geometry(width, height, angle);
      EXPECT_NEAR(bowl.depth, bowl.sphere_radius * (1 - std::cos(angle)), 1e-12 * bowl.depth);
      EXPECT_NEAR(bowl.rim_radius, bowl.sphere_radius * std::sin(angle), 1e-12 * bowl.rim_radius);
      EXPECT_NEAR(map.recommended_amplitude_m, bowl.depth / std::max(width, height), 1e-12);
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          const double distance = std::hypot(x - bowl.center_x, y - bowl.center_y);
          if (distance >= bowl.rim_radius) {
            ASSERT_EQ(map.heights(x, y), 1);
            continue;
          }
          const double below_center = bowl.sphere_radius - bowl.depth * map.heights(x, y);
          // The radius moves by no more than the rounded height does; the last term is rounding in double.
          ASSERT_NEAR(std::hypot(distance, below_center), bowl.sphere_radius,
                      bowl.depth * kHalfUlp + 1e-12 * bowl.sphere_radius);
        }
      }
    }
  }
}

TEST(Bowl, IsSurroundedByFlatGround) {
  const SyntheticMap map = make(SyntheticKind::kBowl, 512, 512);
  const BowlGeometry bowl = bowl_geometry(512, 512, 60 * kDegree);
  EXPECT_EQ(map.heights(bowl.center_x, bowl.center_y), 0);
  for (int i = 0; i < 512; ++i) {
    for (int margin = 0; margin < 20; ++margin) {
      ASSERT_EQ(map.heights(i, margin), 1);
      ASSERT_EQ(map.heights(margin, i), 1);
      ASSERT_EQ(map.heights(i, 511 - margin), 1);
      ASSERT_EQ(map.heights(511 - margin, i), 1);
    }
  }
}

TEST(Groove, FacetsHaveExactlyTheSlopeOfTheWalls) {
  for (const double angle : {45 * kDegree, 30 * kDegree, 80 * kDegree}) {
    for (const int width : {512, 256, 60, 2}) {
      const SyntheticMap map = make(SyntheticKind::kGroove, width, 4, angle);
      const GrooveGeometry groove = groove_geometry(width, angle);
      EXPECT_EQ(width % groove.period, 0);
      EXPECT_EQ(2 * groove.wall_width, groove.period);
      EXPECT_NEAR(groove.depth * std::tan(angle), groove.wall_width, 1e-12 * groove.wall_width);
      const double size_m = std::max(width, 4) * 0.25;  // texels of 0.25 m
      const double amplitude_m = map.recommended_amplitude_m * size_m;
      const Surface surface = make_surface(map.heights, size_m, amplitude_m, Edge::kWrap);
      EXPECT_NEAR(amplitude_m, groove.depth * surface.texel_size_m, 1e-12 * amplitude_m);
      // Two heights rounded to float, twice each (as 0..1 and in metres), over a texel.
      const double tolerance = 4 * 2 * kHalfUlp * amplitude_m / surface.texel_size_m;
      for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
        const glm::dvec3 normal = facet_normal(surface, facet);
        ASSERT_EQ(normal.y, 0);
        ASSERT_NEAR(std::abs(normal.x) / normal.z, 1 / std::tan(angle), tolerance);
      }
    }
  }
}

TEST(Groove, VerticesAndRidgesLieOnTexels) {
  const SyntheticMap map = make(SyntheticKind::kGroove, 512, 8);
  const GrooveGeometry groove = groove_geometry(512, 45 * kDegree);
  EXPECT_EQ(groove.period, 128);
  for (int x = 0; x < 512; x += groove.period) {
    EXPECT_EQ(map.heights(x, 3), 0);
    EXPECT_EQ(map.heights(x + groove.wall_width, 3), 1);
  }
}

void expect_floor_between(const Grid<float>& map, WallGeometry walls) {
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      ASSERT_EQ(map(x, y), x > walls.left_edge && x < walls.right_edge ? 0 : 1) << x << "," << y;
}

TEST(Canyon, FloorLiesBetweenTwoEdges) {
  const WallGeometry walls = canyon_geometry(512);
  EXPECT_EQ(walls.left_edge, 127);
  EXPECT_EQ(walls.right_edge, 384);
  const SyntheticMap map = make(SyntheticKind::kCanyon, 512, 16);
  expect_floor_between(map.heights, walls);
  // Half the opening deep, for a map of 1 m.
  EXPECT_DOUBLE_EQ(map.recommended_amplitude_m, 0.5 * 257 / 512);
}

TEST(Step, FloorLiesToTheRightOfTheWall) {
  const WallGeometry walls = step_geometry(512);
  EXPECT_EQ(walls.left_edge, 255);
  EXPECT_EQ(walls.right_edge, 512);
  const SyntheticMap map = make(SyntheticKind::kStep, 512, 16);
  expect_floor_between(map.heights, walls);
  EXPECT_DOUBLE_EQ(map.recommended_amplitude_m, 0.5 * 257 / 512);
}

}  // namespace
}  // namespace hemibake
