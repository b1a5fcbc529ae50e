// Cost per texel of the disk estimators as the map grows from 128² to 1024² (the same map, more texels): tree
// nodes visited and CPU microseconds for a sample of texels, against the number of nodes there are.
//
//   hemibake_bench_disk [LARGEST SIDE]     1024
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "core/parallel.h"
#include "estimators/disk.h"
#include "estimators/disk_robust.h"
#include "sampling/low_discrepancy.h"
#include "support/maps.h"
#include "support/threads.h"

namespace hemibake {
namespace {

constexpr int kReceivers = 2000;
constexpr double kOpeningRatio = 0.2;

struct TreeCost {
  double nodes, microseconds;  // per texel
  size_t tree_nodes;
};

// One pass of shadows over a sample of the texels.
TreeCost cost_of(const Surface& surface, bool facets) {
  const std::vector<Disk> disks =
      facets ? facet_disks(surface) : vertex_disks(surface, VertexArea::kThirdOfEach);
  const DiskTree tree =
      facets ? make_axis_tree(disks) : make_grid_tree(disks, surface.width(), surface.height());
  const DiskReach reach = make_disk_reach(surface, kOpeningRatio, 0);
  const double start = process_cpu_seconds();
  uint64_t nodes = 0;
  double shadow = 0;
  for (uint64_t i = 0; i < kReceivers; ++i) {
    const size_t at = mix_bits(5, 5, i) % disks.size();
    nodes += visit_disks(tree, reach, disks[at].position, [&](uint32_t node, const glm::dvec3& offset, bool) {
      if (glm::dot(offset, offset) == 0) return;
      const Disk& disk = tree[node].disk;
      shadow += disk_shadow(offset, disk.normal, disk.area_over_pi, disks[at].normal, OccluderSide::kFront);
    });
  }
  const double seconds = process_cpu_seconds() - start;
  if (!std::isfinite(shadow)) std::abort();
  return {static_cast<double>(nodes) / kReceivers, 1e6 * seconds / kReceivers, tree.size()};
}

void run(int largest) {
  for (const bool facets : {false, true}) {
    double before = 0;
    for (int side = 128; side <= largest; side *= 2) {
      const TreeCost cost = cost_of(synthetic_surface(SyntheticKind::kNoise, side, side, 0.1), facets);
      fmt::print("{:11} {:4}^2: {:7.0f} of {:8} nodes, {:6.1f} us per texel{}\n",
                 facets ? "disk-robust" : "disk", side, cost.nodes, cost.tree_nodes, cost.microseconds,
                 before > 0 ? fmt::format(", {:+.0f} nodes", cost.nodes - before) : "");
      before = cost.nodes;
    }
  }
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  hemibake::set_thread_count(1);
  hemibake::run(argc > 1 ? std::atoi(argv[1]) : 1024);
  return 0;
}
