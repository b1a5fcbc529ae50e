#include "estimators/disk_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "estimators/disk.h"
#include "estimators/disk_robust.h"
#include "support/maps.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

double total_area_over_pi(const std::vector<Disk>& disks) {
  double sum = 0;
  for (const Disk& disk : disks) sum += disk.area_over_pi;
  return sum;
}

void expect_whole_tree(const DiskTree& tree, const std::vector<Disk>& disks) {
  std::vector<int> seen(disks.size(), 0);
  for (uint32_t i = 0; i < tree.size(); ++i) {
    const DiskNode& node = tree[i];
    ASSERT_GT(node.next, i);
    ASSERT_LE(node.next, tree.size());
    EXPECT_NEAR(glm::length(node.disk.normal), 1, 1e-12);
    if (node.element != kInnerNode) {
      EXPECT_EQ(node.next, i + 1);
      ++seen[node.element];
      continue;
    }
    double area = 0;
    uint32_t child = i + 1;
    for (; child < node.next; child = tree[child].next) area += tree[child].disk.area_over_pi;
    EXPECT_EQ(child, node.next);  // the last child's next is its parent's
    EXPECT_NEAR(area, node.disk.area_over_pi, 1e-12 * area);
  }
  EXPECT_EQ(tree.front().next, tree.size());
  for (const int count : seen) EXPECT_EQ(count, 1);
  EXPECT_NEAR(tree.front().disk.area_over_pi, total_area_over_pi(disks), 1e-9 * total_area_over_pi(disks));
}

TEST(DiskTree, HoldsEveryDiskOnce) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 13}, {13, 1}, {16, 16}, {21, 10}}) {
    const Surface surface = white_noise_surface(width, height, 0.3);
    const std::vector<Disk> vertices = vertex_disks(surface, VertexArea::kThirdOfEach);
    expect_whole_tree(make_grid_tree(vertices, width, height), vertices);
    const std::vector<Disk> facets = facet_disks(surface);
    expect_whole_tree(make_axis_tree(facets), facets);
    // A third of each facet to each corner, and facets whole, are both the area of the surface.
    EXPECT_NEAR(total_area_over_pi(vertices), total_area_over_pi(facets), 1e-9 * total_area_over_pi(facets));
  }
}

TEST(DiskTree, ValuesAreAveragedByArea) {
  const Surface surface = white_noise_surface(9, 6, 0.4);
  const std::vector<Disk> disks = facet_disks(surface);
  std::vector<double> values(disks.size());
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    values[i] = unit_interval(mix_bits(1, 2, i));
    sum += values[i] * disks[i].area_over_pi;
  }
  EXPECT_NEAR(values_of_nodes(make_axis_tree(disks), values)[0], sum / total_area_over_pi(disks), 1e-12);
}

// Every disk of every copy within the radius, by counting: what a walk with ratio 0 must visit.
TEST(DiskTree, VisitsEveryCopyWithinTheRadius) {
  const Surface surface = white_noise_surface(7, 5, 0.3);
  const std::vector<Disk> disks = vertex_disks(surface, VertexArea::kThirdOfEach);
  const DiskTree tree = make_grid_tree(disks, 7, 5);
  for (const double radius_texels : {0.5, 3.0, 11.0, 40.0}) {
    const DiskReach reach = make_disk_reach(surface, 0, radius_texels * surface.texel_size_m);
    for (const glm::dvec3 receiver : {glm::dvec3(0, 0, 1), glm::dvec3(6, 4, 0), glm::dvec3(3.3, 2.7, 5)}) {
      int expected = 0, found = 0;
      for (int y = -60; y <= 60; ++y)
        for (int x = -60; x <= 60; ++x)
          expected += std::hypot(x - receiver.x, y - receiver.y) <= radius_texels * (1 + 1e-12);
      visit_disks(tree, reach, receiver, [&](uint32_t i, const glm::dvec3&, bool) {
        EXPECT_NE(tree[i].element, kInnerNode);
        ++found;
      });
      EXPECT_EQ(found, expected) << radius_texels;
    }
  }
}

// Nodes visited per receiver from 64² to 512² of the same map: about the same number more with every
// doubling.
TEST(DiskTree, CostGrowsLikeTheLogarithm) {
  for (const bool facets : {false, true}) {
    std::vector<double> visited;
    for (const int size : {64, 128, 256, 512}) {
      const Surface surface = synthetic_surface(SyntheticKind::kNoise, size, size, 0.1);
      const std::vector<Disk> disks =
          facets ? facet_disks(surface) : vertex_disks(surface, VertexArea::kThirdOfEach);
      const DiskTree tree = facets ? make_axis_tree(disks) : make_grid_tree(disks, size, size);
      const DiskReach reach = make_disk_reach(surface, 0.2, 0);
      uint64_t nodes = 0;
      constexpr int kReceivers = 400;
      for (int i = 0; i < kReceivers; ++i) {
        const size_t disk = mix_bits(5, 5, static_cast<uint64_t>(i)) % disks.size();
        nodes += visit_disks(tree, reach, disks[disk].position, [](uint32_t, const glm::dvec3&, bool) {});
      }
      visited.push_back(static_cast<double>(nodes) / kReceivers);
      std::printf("%s, %3d^2: %6.0f nodes visited of %zu\n", facets ? "facets" : "vertices", size,
                  visited.back(), tree.size());
    }
    // Proportional to n would be 64 times as many, to √n 8 times.
    EXPECT_LT(visited[3] / visited[0], 2.5);
    // Each doubling adds about the same: log n, no power of it.
    EXPECT_LT(visited[3] - visited[2], 1.5 * (visited[1] - visited[0]) + 20);
  }
}

}  // namespace
}  // namespace hemibake
