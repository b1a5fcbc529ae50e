#include "surface/patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>

#include "sampling/low_discrepancy.h"
#include "support/maps.h"
#include "support/patch_means.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

// Smooth in its left half, rough in its right one; 40 cells end in a run of 8, 21 rows in a tile of 5.
Surface half_rough_surface(Edge edge) {
  Surface surface = white_noise_surface(40, 21, 0.5, edge);
  for (int y = 0; y < 21; ++y)
    for (int x = 0; x < 20; ++x) surface.heights_m(x, y) = 0.25f;
  return surface;
}

TEST(PatchKind, TexelsAreTheirOwn) {
  const Surface surface = white_noise_surface(7, 5, 0.1);
  const PatchSet patches = make_patches(surface, PatchKind::kTexels);
  EXPECT_EQ(patches.count, 35u);
  EXPECT_EQ(patch_position_texels(surface, patches, 16), glm::dvec2(2, 2));
}

TEST(PatchKind, EveryNodeOfEveryFacetOnce) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = half_rough_surface(edge);
    const PatchSet patches = make_patches(surface, PatchKind::kFacets);
    std::map<uint32_t, uint32_t> nodes_of;  // bits
    for (uint32_t patch = 0; patch < patches.count; ++patch) {
      const FacetNode node = facet_node(patches, patch);
      EXPECT_EQ(nodes_of[node.facet] >> node.node & 1, 0u);
      nodes_of[node.facet] |= 1u << node.node;
      EXPECT_EQ(patch_at(patches, node.facet, node.node), patch);
      // Its own light is all it draws.
      const glm::dvec2 uv = node_uv(node.node);
      for (const double choice : {0.0, 0.5, 0.999999})
        EXPECT_EQ(sample_patch(patches, node.facet, uv, choice), patch);
    }
    EXPECT_EQ(nodes_of.size(), facet_count(surface));
    for (const auto& [facet, nodes] : nodes_of) {
      const auto corners = facet_positions_texels(surface, facet);
      double longest = 0;
      for (size_t i = 0; i < 3; ++i)
        longest = std::max(longest, glm::distance(corners[i], corners[(i + 1) % 3]));
      EXPECT_EQ(nodes, (1u << (longest > 2 ? 15 : 6)) - 1) << facet;
    }
  }
}

TEST(PatchKind, ATileIsOnePieceOfMemory) {
  const Surface surface = half_rough_surface(Edge::kOpen);
  const PatchSet patches = make_patches(surface, PatchKind::kFacets);
  uint32_t run = 0;
  for (const uint32_t first_row : {0u, 16u})
    for (const uint32_t x : {0u, 16u, 32u})
      for (uint32_t y = first_row; y < std::min(21u, first_row + 16); ++y, ++run) {
        if (patches.runs[run].first == patches.runs[run + 1].first) continue;
        const PatchRun found = run_of_patch(patches, patches.runs[run].first);
        EXPECT_EQ(found.x, x);
        EXPECT_EQ(found.y, y);
        EXPECT_EQ(run_of_patch(patches, patches.runs[run + 1].first - 1).first, found.first);
      }
  EXPECT_EQ(patches.runs.size(), run + 1);
}

// What stands at one place comes in one slot after the other, of one run.
TEST(PatchKind, NodesOfOnePlaceAreOfOneSite) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = half_rough_surface(edge);
    const PatchSet patches = make_patches(surface, PatchKind::kFacets);
    for (uint32_t patch = 0; patch < patches.count; ++patch) {
      const PatchRun run = run_of_patch(patches, patch);
      const FacetNode node = facet_node(patches, patch);
      const NodeSlot& slot = kNodeSites.slots[kNodeSites.slot_of[node.facet % 2][node.node]];
      const NodeSite& site = kNodeSites.sites[slot.site];
      const glm::dvec2 at = patch_position_texels(surface, patches, patch) - glm::dvec2(site.x, site.y) / 4.0;
      const auto x = static_cast<uint32_t>(at.x) % 40, y = static_cast<uint32_t>(at.y) % 21;
      EXPECT_EQ(y, run.y);
      EXPECT_TRUE(x >= run.x && x < run.x + run.texels);
      EXPECT_EQ(facet_of_slot(patches, kNodeSites.slot_of[node.facet % 2][node.node], x, y), node.facet);
    }
  }
}

// Light that is linear on a facet comes back exactly in the mean over the choices, wherever it is asked for;
// also beyond the facet's border by rounding.
TEST(PatchKind, DrawsReproduceLinearLight) {
  const Surface surface = half_rough_surface(Edge::kWrap);
  const PatchSet patches = make_patches(surface, PatchKind::kFacets);
  constexpr int kChoices = 3000;
  for (const uint32_t facet : {0u, 1u, 35u, 60u, 61u}) {
    for (const glm::dvec2 uv : {glm::dvec2(0.1, 0.2),
                                {0.4, 0.35},
                                {0.6, 0.4},
                                {0.24, 0.26},
                                {0, 0.7},
                                {0.3, 0.7},
                                {1, 0},
                                {0, 1},
                                {0.5, 0.5},
                                {1 + 1e-7, -1e-7},
                                {0.7, 0.3000001}}) {
      glm::dvec2 mean(0);
      for (int i = 0; i < kChoices; ++i) {
        const FacetNode node = facet_node(patches, sample_patch(patches, facet, uv, (i + 0.5) / kChoices));
        EXPECT_EQ(node.facet, facet);
        mean += node_uv(node.node) / static_cast<double>(kChoices);
      }
      // The choices are a comb of 3000 teeth; each of the three shares is off by less than one of them.
      EXPECT_NEAR(mean.x, uv.x, 1.0 / kChoices) << facet << ' ' << uv.x << ' ' << uv.y;
      EXPECT_NEAR(mean.y, uv.y, 1.0 / kChoices) << facet << ' ' << uv.x << ' ' << uv.y;
    }
  }
}

// ∫ over the unit triangle, over its area: 1, 1/3 for u and v, 1/6 for u², 1/12 for uv. Of the quadratics the
// linear part of the rule is wrong: on triangles of side s = 1/k the mean of u² by s²/6, of uv by −s²/12.
TEST(PatchKind, AreaShares) {
  for (const int k : {kCoarseSubdivision, kFineSubdivision}) {
    const double linear = k == kCoarseSubdivision ? 0 : 0.75;
    double one = 0, u = 0, v = 0, uu = 0, uv = 0;
    for (uint32_t node = 0; node < node_count(k); ++node) {
      const double share = node_area_share(k, node);
      const glm::dvec2 at = node_uv(node);
      EXPECT_GE(share, 0);
      one += share;
      u += share * at.x;
      v += share * at.y;
      uu += share * at.x * at.x;
      uv += share * at.x * at.y;
    }
    EXPECT_NEAR(one, 1, 1e-15);
    EXPECT_NEAR(u, 1.0 / 3, 1e-15);
    EXPECT_NEAR(v, 1.0 / 3, 1e-15);
    EXPECT_NEAR(uu, 1.0 / 6 + linear / (6.0 * k * k), 1e-15);
    EXPECT_NEAR(uv, 1.0 / 12 - linear / (12.0 * k * k), 1e-15);
  }
}

TEST(PatchKind, AreasAddUpToTheSurface) {
  const Surface surface = half_rough_surface(Edge::kWrap);
  const PatchSet patches = make_patches(surface, PatchKind::kFacets);
  double facets = 0, nodes = 0;
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet)
    facets += facet_area_ratio(surface, facet) / 2;
  for (uint32_t patch = 0; patch < patches.count; ++patch)
    nodes += patch_area_texels(surface, patches, patch);
  EXPECT_NEAR(nodes / facets, 1, 1e-12);
}

TEST(PatchKind, StartsLieOnTheFacetNearTheNode) {
  for (const int k : {kCoarseSubdivision, kFineSubdivision})
    for (uint32_t node = 0; node < node_count(k); ++node)
      for (const glm::dvec2 point : {glm::dvec2(0.3, 0.3), {0.01, 0.9}, {0.9, 0.05}}) {
        const glm::dvec2 start = node_start_uv(node, point), at = node_uv(node);
        EXPECT_TRUE(start.x > 0 && start.y > 0 && start.x + start.y < 1);
        EXPECT_LT(std::max(std::abs(start.x - at.x), std::abs(start.y - at.y)), 0.11 / k);
      }
}

// Position and coordinates are each other's inverse on every copy of the map.
TEST(PatchKind, FacetCoordinatesFindThePointAgain) {
  const Surface surface = white_noise_surface(6, 4, 0.3);
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet)
    for (const glm::dvec2 uv : {glm::dvec2(0.2, 0.3), {0.98, 0.01}, {0, 0}, {0.01, 0.98}})
      for (const glm::dvec2 copies : {glm::dvec2(0, 0), {6, 0}, {-12, 8}}) {
        const glm::dvec2 found =
            facet_coordinates(surface, facet, facet_point_texels(surface, facet, uv) + copies);
        EXPECT_NEAR(found.x, uv.x, 1e-13);
        EXPECT_NEAR(found.y, uv.y, 1e-13);
      }
}

}  // namespace
}  // namespace hemibake
