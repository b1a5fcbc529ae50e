#include "estimators/disk_tree.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "core/error.h"
#include "estimators/estimate.h"

namespace hemibake {
namespace {

// Calls each(child) for the children of a node.
template <class Each>
void for_each_child(const DiskTree& tree, size_t node, const Each& each) {
  for (size_t child = node + 1; child < tree[node].next; child = tree[child].next) each(child);
}

// Completes an inner node after its subtree was appended.
void complete_node(DiskTree& tree, size_t node, bool weigh_by_area) {
  tree[node].next = static_cast<uint32_t>(tree.size());
  tree[node].element = kInnerNode;
  glm::dvec3 position(0), normal(0);
  double weights = 0, area_over_pi = 0;
  for_each_child(tree, node, [&](size_t child) {
    const Disk& disk = tree[child].disk;
    const double weight = weigh_by_area ? disk.area_over_pi : 1.0;
    position += weight * disk.position;
    normal += weight * disk.normal;
    weights += weight;
    area_over_pi += disk.area_over_pi;
  });
  // Normals of a height map all have z > 0, so their sum is never zero.
  tree[node].disk = {position / weights, glm::normalize(normal), area_over_pi};
}

void append_leaf(DiskTree& tree, const Disk& disk, uint32_t element) {
  tree.push_back({disk, static_cast<uint32_t>(tree.size() + 1), element});
}

struct GridTreeBuilder {
  const std::vector<Disk>& disks;
  int width;
  DiskTree tree;

  // Appends the subtree of columns x0..x1 and rows y0..y1, ends excluded, not empty.
  void append(int x0, int y0, int x1, int y1) {
    if (x1 - x0 == 1 && y1 - y0 == 1) {
      const uint32_t element =
          static_cast<uint32_t>(y0) * static_cast<uint32_t>(width) + static_cast<uint32_t>(x0);
      append_leaf(tree, disks[element], element);
      return;
    }
    const size_t node = tree.size();
    tree.emplace_back();
    const std::array<int, 3> xs{x0, (x0 + x1 + 1) / 2, x1}, ys{y0, (y0 + y1 + 1) / 2, y1};
    for (size_t row = 0; row < 2; ++row)
      for (size_t column = 0; column < 2; ++column)
        if (xs[column] < xs[column + 1] && ys[row] < ys[row + 1])
          append(xs[column], ys[row], xs[column + 1], ys[row + 1]);
    complete_node(tree, node, false);
  }
};

struct AxisTreeBuilder {
  const std::vector<Disk>& disks;
  std::vector<uint32_t> order;
  DiskTree tree;

  void append(size_t begin, size_t end) {
    if (end - begin == 1) {
      append_leaf(tree, disks[order[begin]], order[begin]);
      return;
    }
    const size_t node = tree.size();
    tree.emplace_back();
    const size_t middle = begin + (end - begin) / 2;
    const int axis = dominant_axis(begin, end);
    // Equal coordinates are ordered by index, so that the halves are the same on every machine.
    std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
      const double pa = disks[a].position[axis], pb = disks[b].position[axis];
      return pa != pb ? pa < pb : a < b;
    });
    append(begin, middle);
    append(middle, end);
    complete_node(tree, node, true);
  }

  std::vector<uint32_t>::iterator at(size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); }

  int dominant_axis(size_t begin, size_t end) const {
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (size_t i = begin; i < end; ++i) {
      const glm::dvec3& p = disks[order[i]].position;
      for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
    const glm::dvec3 spread = high - low;
    if (spread.x >= spread.y && spread.x >= spread.z) return 0;
    return spread.y >= spread.z ? 1 : 2;
  }
};

}  // namespace

DiskTree make_grid_tree(const std::vector<Disk>& disks, int width, int height) {
  expect_equal(disks.size(), static_cast<size_t>(width) * static_cast<size_t>(height),
               "disks of a grid tree");
  GridTreeBuilder builder{disks, width, {}};
  builder.tree.reserve(disks.size() + disks.size() / 2);
  builder.append(0, 0, width, height);
  return std::move(builder.tree);
}

DiskTree make_axis_tree(const std::vector<Disk>& disks) {
  AxisTreeBuilder builder{disks, std::vector<uint32_t>(disks.size()), {}};
  std::iota(builder.order.begin(), builder.order.end(), 0u);
  builder.tree.reserve(2 * disks.size());
  if (!disks.empty()) builder.append(0, disks.size());
  return std::move(builder.tree);
}

std::vector<double> values_of_nodes(const DiskTree& tree, const std::vector<double>& values_of_elements) {
  std::vector<double> values(tree.size());
  // Children follow their parents.
  for (size_t node = tree.size(); node-- > 0;) {
    if (tree[node].element != kInnerNode) {
      values[node] = values_of_elements[tree[node].element];
      continue;
    }
    double sum = 0;
    for_each_child(tree, node, [&](size_t child) { sum += tree[child].disk.area_over_pi * values[child]; });
    values[node] = sum / tree[node].disk.area_over_pi;
  }
  return values;
}

DiskReach make_disk_reach(const Surface& surface, double opening_ratio, double radius_m) {
  DiskReach reach{opening_ratio, std::numeric_limits<double>::infinity()};
  if (radius_m > 0) reach.radius_texels = radius_m / surface.texel_size_m;
  if (surface.edge != Edge::kWrap) return reach;
  reach.period = {surface.width(), surface.height()};
  if (!(radius_m > 0)) reach.radius_texels = far_radius_m(surface) / surface.texel_size_m;
  return reach;
}

CopyRange copies_in_reach(const DiskReach& reach, const glm::dvec3& receiver) {
  CopyRange copies;
  for (int axis = 0; axis < 2; ++axis) {
    const int period = reach.period[axis];
    if (period == 0) continue;
    // Disks of a copy lie between its first texel and its last facet, a texel farther on.
    copies.first[axis] =
        static_cast<int>(std::ceil((receiver[axis] - reach.radius_texels - period) / period));
    copies.last[axis] = static_cast<int>(std::floor((receiver[axis] + reach.radius_texels) / period));
  }
  return copies;
}

}  // namespace hemibake
