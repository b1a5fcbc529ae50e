#include "surface/facets.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "surface/synthetic/noise.h"

namespace hemibake {
namespace {

Surface random_surface(int width, int height, Edge edge, double amplitude_m) {
  Grid<float> heights(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) heights(x, y) = static_cast<float>(hash_unit(3, x, y));
  return make_surface(std::move(heights), 2, amplitude_m, edge);
}

TEST(Facets, CountsCellsTwice) {
  EXPECT_EQ(facet_count(random_surface(5, 3, Edge::kWrap, 1)), 30u);
  EXPECT_EQ(facet_count(random_surface(5, 3, Edge::kOpen, 1)), 16u);
  EXPECT_EQ(facet_columns(random_surface(5, 3, Edge::kWrap, 1)), 5u);
  EXPECT_EQ(facet_columns(random_surface(5, 3, Edge::kOpen, 1)), 4u);
  EXPECT_EQ(facet_count(random_surface(1, 1, Edge::kWrap, 1)), 2u);
  EXPECT_EQ(facet_count(random_surface(1, 7, Edge::kWrap, 1)), 14u);
}

TEST(Facets, AreNumberedRowByRow) {
  const Surface surface = random_surface(5, 3, Edge::kOpen, 1);
  const auto even = facet_corners(surface, 2 * (4 * 1 + 2)).texel;  // cell (2, 1) of 4 × 2
  EXPECT_EQ(even[0], glm::ivec2(2, 1));
  EXPECT_EQ(even[1], glm::ivec2(3, 1));
  EXPECT_EQ(even[2], glm::ivec2(2, 2));
  const auto odd = facet_corners(surface, 2 * (4 * 1 + 2) + 1).texel;
  EXPECT_EQ(odd[0], glm::ivec2(3, 2));
  EXPECT_EQ(odd[1], glm::ivec2(2, 2));
  EXPECT_EQ(odd[2], glm::ivec2(3, 1));
}

TEST(Facets, CornersOfAWrappingMapReachOverItsBorder) {
  const Surface surface = random_surface(5, 3, Edge::kWrap, 0.7);
  const uint32_t last = facet_count(surface) - 1;
  EXPECT_EQ(facet_corners(surface, last).texel[0], glm::ivec2(5, 3));
  const auto positions = facet_positions_texels(surface, last);
  EXPECT_EQ(positions[0], glm::dvec3(5, 3, surface.heights_m(0, 0) / surface.texel_size_m));
  EXPECT_EQ(positions[1], glm::dvec3(4, 3, surface.heights_m(4, 0) / surface.texel_size_m));
  EXPECT_EQ(positions[2], glm::dvec3(5, 2, surface.heights_m(0, 2) / surface.texel_size_m));
}

TEST(Facets, NormalAndAreaAreThoseOfTheTriangle) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    for (const double amplitude_m : {0.0, 1e-6, 0.3, 1e3}) {
      const Surface surface = random_surface(13, 9, edge, amplitude_m);
      for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
        const auto p = facet_positions_texels(surface, facet);
        const glm::dvec3 cross = glm::cross(p[1] - p[0], p[2] - p[0]);
        const glm::dvec3 normal = facet_normal(surface, facet);
        ASSERT_GT(normal.z, 0);
        ASSERT_LT(glm::length(normal - glm::normalize(cross)), 1e-13) << facet;
        // The shadow of every facet on the ground is half a texel.
        const double ratio = glm::length(cross) / 2 / 0.5;
        ASSERT_NEAR(facet_area_ratio(surface, facet), ratio, 1e-12 * ratio);
      }
    }
  }
}

TEST(Facets, CoverTheGroundOnce) {
  // The normals of a closed (tiling) surface, weighted by area, sum to the ground's: (0, 0, area of the
  // tile).
  const Surface surface = random_surface(8, 6, Edge::kWrap, 0.5);
  glm::dvec3 sum(0);
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet)
    sum += 0.5 * facet_area_ratio(surface, facet) * facet_normal(surface, facet);
  EXPECT_NEAR(sum.x, 0, 1e-12);
  EXPECT_NEAR(sum.y, 0, 1e-12);
  EXPECT_NEAR(sum.z, 48, 1e-12);
}

}  // namespace
}  // namespace hemibake
