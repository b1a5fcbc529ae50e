#include "reference/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "reference/random.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

Surface random_surface(int width, int height, double range_texels, Edge edge, uint64_t seed) {
  RefereeRandom random(seed, 0, 0);
  Grid<float> heights(width, height);
  for (float& h : heights.values) h = static_cast<float>(random.uniform());
  return make_surface(heights, std::max(width, height) * 0.25, range_texels * 0.25,
                      edge);  // texels of 0.25 m
}

struct NearestHit {
  double distance = HUGE_VAL;
  uint32_t facet = 0;
};

// Every triangle of the copies up to `tiles` away, by Möller & Trumbore, "Fast, Minimum Storage Ray/Triangle
// Intersection", 1997.
NearestHit brute_force(const Surface& surface, const glm::dvec3& start, const glm::dvec3& direction,
                       int tiles) {
  NearestHit nearest;
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
    const auto corners = facet_positions_texels(surface, facet);
    const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
    const glm::dvec3 p = glm::cross(direction, b);
    const double determinant = glm::dot(a, p);
    if (determinant == 0) continue;
    for (int y = -tiles; y <= tiles; ++y) {
      for (int x = -tiles; x <= tiles; ++x) {
        const glm::dvec3 s = start - corners[0] - glm::dvec3(x * surface.width(), y * surface.height(), 0);
        const glm::dvec3 q = glm::cross(s, a);
        const double u = glm::dot(s, p) / determinant, v = glm::dot(direction, q) / determinant;
        const double t = glm::dot(b, q) / determinant;
        if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < nearest.distance) nearest = {t, facet};
      }
    }
  }
  return nearest;
}

// Rays from random points on the surface in all directions, against brute force.
void compare_with_brute_force(const Surface& surface, int tiles) {
  const HeightFieldRayCaster caster(surface);
  RefereeRandom random(3, 1, 4);
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const uint32_t facet = random.below(caster.facet_count());
    SurfacePoint at =
        caster.point_on_facet(facet, 0.1 + 0.3 * random.uniform(), 0.1 + 0.3 * random.uniform());
    ASSERT_LT(glm::length(at.normal - facet_normal(surface, facet)), 1e-6);
    at.position.z += 1e-3;
    const glm::dvec3 direction = random_cosine_direction({0, 0, i % 2 == 0 ? 1 : 0.01}, random);
    const NearestHit expected = brute_force(surface, at.position, direction, tiles);
    SurfacePoint hit;
    const RayOutcome end = caster.cast(at.position, direction, hit);
    ASSERT_EQ(end == RayOutcome::kHit, std::isfinite(expected.distance)) << "ray " << i;
    if (end != RayOutcome::kHit) continue;
    ++hits;
    const glm::dvec3 position = at.position + expected.distance * direction;
    const double x = std::remainder(hit.position.x - position.x, surface.width());
    const double y = std::remainder(hit.position.y - position.y, surface.height());
    EXPECT_LT(std::hypot(x, y, hit.position.z - position.z), 1e-9 * (1 + expected.distance)) << "ray " << i;
    EXPECT_LT(glm::length(hit.normal - facet_normal(surface, expected.facet)), 1e-6) << "ray " << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(HeightFieldRayCaster, AgreesWithEveryTriangleOfAWrappingMap) {
  compare_with_brute_force(random_surface(5, 3, 4, Edge::kWrap, 1), 40);
}

TEST(HeightFieldRayCaster, AgreesWithEveryTriangleOfAnOpenMap) {
  compare_with_brute_force(random_surface(23, 18, 6, Edge::kOpen, 2), 0);
}

TEST(HeightFieldRayCaster, AgreesWithEveryTriangleWhereBlocksAreSkipped) {
  Surface surface = random_surface(37, 29, 0.5, Edge::kOpen, 3);
  // Two towers far apart: most of the way is skipped in blocks.
  surface.heights_m(3, 4) = surface.heights_m(30, 20) = 20;
  compare_with_brute_force(surface, 0);
}

TEST(HeightFieldRayCaster, FindsWhatIsManyTilesAway) {
  // A comb of walls 16 texels apart; the ray falls from 14 to 10, their height, over 300 tiles.
  Grid<float> heights(16, 1);
  heights(8, 0) = 1;
  const Surface surface = make_surface(heights, 16, 10, Edge::kWrap);  // texel 1 m, walls 10 m
  const HeightFieldRayCaster caster(surface);
  SurfacePoint hit;
  const double run = 16 * 300.0;
  ASSERT_EQ(caster.cast({0.5, 0.25, 14}, glm::normalize(glm::dvec3(run, 0, -4)), hit), RayOutcome::kHit);
  EXPECT_NEAR(hit.position.x, 8, 1.0);
  EXPECT_NEAR(hit.position.z, 10, 0.1);
  EXPECT_EQ(hit.position.y, 0.25);
}

TEST(HeightFieldRayCaster, VerticalAndHorizontalRaysEnd) {
  const Surface surface = random_surface(9, 7, 3, Edge::kWrap, 4);
  const HeightFieldRayCaster caster(surface);
  SurfacePoint hit;
  EXPECT_EQ(caster.cast({2, 3, 5}, {0, 0, 1}, hit), RayOutcome::kEscaped);
  EXPECT_EQ(caster.cast({2.25, 3.5, 5}, {0, 0, -1}, hit), RayOutcome::kHit);
  EXPECT_EQ(hit.position.x, 2.25);
  EXPECT_EQ(hit.position.y, 3.5);
  EXPECT_EQ(caster.cast({2, 3, 5}, {1, 0, 0}, hit), RayOutcome::kEscaped);
  // On the far edge of the map, along it.
  EXPECT_EQ(caster.cast({9, 3.5, 2.9}, glm::normalize(glm::dvec3(0, 1, 0.1)), hit), RayOutcome::kEscaped);
  EXPECT_EQ(caster.cast({9, 7, 5}, {0, 0, -1}, hit), RayOutcome::kHit);
}

TEST(HeightFieldRayCaster, HorizontalRayInAnEndlessTrenchIsTruncated) {
  Grid<float> heights(4, 4);
  for (int y = 0; y < 4; ++y) heights(0, y) = 1;
  const Surface surface = make_surface(heights, 4, 1, Edge::kWrap);
  SurfacePoint hit;
  EXPECT_EQ(HeightFieldRayCaster(surface).cast({2, 0, 0.5}, {0, 1, 0}, hit), RayOutcome::kTruncated);
}

TEST(HeightFieldRayCaster, OneTexelIsAPlane) {
  const Surface surface = make_surface(Grid<float>(1, 1, 0.5f), 1, 1, Edge::kWrap);
  SurfacePoint hit;
  EXPECT_EQ(HeightFieldRayCaster(surface).cast({0, 0, 0}, glm::normalize(glm::dvec3(1, 0, 1e-9)), hit),
            RayOutcome::kEscaped);
  ASSERT_EQ(HeightFieldRayCaster(surface).cast({0, 0, 0.5}, glm::normalize(glm::dvec3(1, 1, -0.1)), hit),
            RayOutcome::kHit);
  EXPECT_NEAR(hit.position.z, 0, 1e-12);
  EXPECT_EQ(hit.normal, glm::dvec3(0, 0, 1));
}

}  // namespace
}  // namespace hemibake
