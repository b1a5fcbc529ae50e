// A tree of oriented disks in one array, child first: a node's first child follows it, and `next` leads past
// its whole subtree, so that traversal needs neither recursion nor a stack (Bunnell, GPU Gems 2, ch. 14).
//
// Lengths are in texels. A wrapping map is traversed copy by copy: the disks within `radius` (horizontally)
// of the receiver of every copy of the tree. On a map with height range H, farther disks lie within
// atan(H/radius) of the horizon: at most H/radius of α and (H/radius)² of E₀/π for a level receiver.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "surface/surface.h"

namespace hemibake {

struct Disk {
  glm::dvec3 position;
  glm::dvec3 normal;  // unit
  double area_over_pi;
};

struct DiskNode {
  Disk disk;
  uint32_t next;     // the node after this one's subtree
  uint32_t element;  // of a leaf; kInnerNode otherwise
};

inline constexpr uint32_t kInnerNode = std::numeric_limits<uint32_t>::max();

using DiskTree = std::vector<DiskNode>;

// Builds a tree of blocks of texels halved both ways. Position and normal of a node are the plain averages of
// its children, its area their sum (as published). disks: one per texel, row by row.
DiskTree make_grid_tree(const std::vector<Disk>& disks, int width, int height);

// Builds a tree of any disks, halved at the median of the axis along which they spread most. Position and
// normal of a node are averages weighted by area (Hoberock & Jia, GPU Gems 3, ch. 12).
DiskTree make_axis_tree(const std::vector<Disk>& disks);

// Averages values up the tree by area. Returns one per node. values_of_elements: one per disk.
std::vector<double> values_of_nodes(const DiskTree& tree, const std::vector<double>& values_of_elements);

struct DiskReach {
  // A node stands for its children if the root of its area over π is below this many times its distance; 0:
  // never.
  double opening_ratio;
  double radius_texels;  // infinite only with open edges
  glm::ivec2 period{0};  // width and height of a wrapping map; 0 with open edges
};

// Makes a reach in texels. radius_m: 0..; 0: far_radius_m on a wrapping map, no limit on an open one.
DiskReach make_disk_reach(const Surface& surface, double opening_ratio, double radius_m);

// Copies of the map from first to last, in map lengths.
struct CopyRange {
  glm::ivec2 first{0}, last{0};
};
// Returns the copies of the map within reach of a receiver.
CopyRange copies_in_reach(const DiskReach& reach, const glm::dvec3& receiver);

// Calls visit(node index, offset from the receiver to the disk, whether in the receiver's own copy) for every
// disk that counts. Returns the number of nodes visited.
template <class Visit>
uint64_t visit_disks(const DiskTree& tree, const DiskReach& reach, const glm::dvec3& receiver,
                     const Visit& visit) {
  const double opening2 = reach.opening_ratio * reach.opening_ratio;
  const double radius2 = reach.radius_texels * reach.radius_texels;
  const uint32_t end = static_cast<uint32_t>(tree.size());
  const CopyRange copies = copies_in_reach(reach, receiver);
  uint64_t visited = 0;
  for (int y = copies.first.y; y <= copies.last.y; ++y) {
    for (int x = copies.first.x; x <= copies.last.x; ++x) {
      const glm::dvec3 from_copy(receiver.x - x * reach.period.x, receiver.y - y * reach.period.y,
                                 receiver.z);
      const bool own_copy = x == 0 && y == 0;
      for (uint32_t i = 0; i < end;) {
        const DiskNode& node = tree[i];
        const glm::dvec3 offset = node.disk.position - from_copy;
        ++visited;
        if (node.element == kInnerNode && node.disk.area_over_pi >= opening2 * glm::dot(offset, offset)) {
          ++i;
          continue;
        }
        if (offset.x * offset.x + offset.y * offset.y <= radius2) visit(i, offset, own_copy);
        i = node.next;
      }
    }
  }
  return visited;
}

}  // namespace hemibake
