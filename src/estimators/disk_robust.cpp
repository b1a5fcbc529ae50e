#include "estimators/disk_robust.h"

#include <algorithm>
#include <cmath>

#include "estimators/disk_passes.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

// Returns the height at which receivers start, as the rays of the truth do: a thousandth of a texel, or of
// the height range if that is lower.
double receiver_lift_texels(const Surface& surface) {
  const double range = height_range_m(surface) / surface.texel_size_m;
  return 1e-3 * (range > 0 ? std::min(1.0, range) : 1.0);
}

struct RobustPasses {
  const Surface& surface;
  const DiskRobustOptions& options;
  std::vector<Disk> disks;
  DiskTree tree;
  DiskReach reach;
  double distance_attenuation;  // per texel

  RobustPasses(const Surface& of, const DiskRobustOptions& with)
      : surface(of),
        options(with),
        disks(facet_disks(of)),
        tree(make_axis_tree(disks)),
        reach(make_disk_reach(of, with.opening_ratio, with.radius_m)),
        distance_attenuation(with.distance_attenuation_per_m * of.texel_size_m) {}

  double attenuated(double shadow, const glm::dvec3& offset) const {
    return shadow / (1 + distance_attenuation * glm::length(offset));
  }

  double disk_factor(uint32_t node, const glm::dvec3& offset, const glm::dvec3& normal) const {
    const Disk& disk = tree[node].disk;
    return disk_form_factor(offset, disk.normal, disk.area_over_pi, normal, options.side);
  }

  // offset: from the receiver to the facet's centroid.
  double facet_factor(uint32_t facet, const glm::dvec3& offset, const glm::dvec3& normal) const {
    auto corners = facet_positions_texels(surface, facet);
    for (glm::dvec3& corner : corners) corner += offset - disks[facet].position;
    const double factor = polygon_form_factor(clip_to_horizon(corners, normal).corners(), normal);
    return std::max(0.0, options.side == OccluderSide::kFront ? factor : -factor);
  }

  // Updates the accessibility of every facet from that of the pass before. Returns the nodes visited.
  uint64_t pass_over_facets(std::vector<double>& accessibility, Progress& progress) const {
    const std::vector<double> emitters = values_of_nodes(tree, accessibility);
    return for_each_receiver(disks.size(), progress, [&](size_t facet) {
      const glm::dvec3& normal = disks[facet].normal;
      ShadowSum shadows;
      const auto add_shadow = [&](uint32_t i, const glm::dvec3& offset, bool own_copy) {
        if (own_copy && tree[i].element == facet) return;
        const double factor = disk_factor(i, offset, normal);
        if (factor > 0) shadows.add(attenuated(factor * emitters[i], offset), offset);
      };
      const uint64_t visited = visit_disks(tree, reach, disks[facet].position, add_shadow);
      accessibility[facet] = shadows.accessibility();
      return visited;
    });
  }

  uint64_t pass_over_texels(const std::vector<double>& accessibility, Estimate& estimate,
                            Progress& progress) const {
    std::vector<double> emitters = values_of_nodes(tree, accessibility);
    for (double& value : emitters) value = std::pow(value, options.triangle_attenuation);
    const double lift = receiver_lift_texels(surface);
    return for_each_receiver(estimate.ao.size(), progress, [&](size_t texel) {
      const int x = static_cast<int>(texel) % surface.width(), y = static_cast<int>(texel) / surface.width();
      const glm::dvec3 receiver(x, y, surface.heights_m[texel] / surface.texel_size_m + lift);
      const glm::dvec3 normal(surface.normals[texel]);
      ShadowSum shadows;
      const auto add_shadow = [&](uint32_t i, const glm::dvec3& offset, bool) {
        const bool exact = options.robust && tree[i].element != kInnerNode;
        const double factor =
            exact ? facet_factor(tree[i].element, offset, normal) : disk_factor(i, offset, normal);
        if (factor > 0) shadows.add(attenuated(factor * emitters[i], offset), offset);
      };
      const uint64_t visited = visit_disks(tree, reach, receiver, add_shadow);
      estimate.ao[texel] = static_cast<float>(shadows.accessibility());
      estimate.bent_normals[texel] = glm::vec3(shadows.bent_normal(normal));
      return visited;
    });
  }
};

}  // namespace

std::vector<Disk> facet_disks(const Surface& surface) {
  std::vector<Disk> disks(facet_count(surface));
  for (uint32_t facet = 0; facet < disks.size(); ++facet) {
    const auto corners = facet_positions_texels(surface, facet);
    disks[facet] = {(corners[0] + corners[1] + corners[2]) / 3.0, facet_normal(surface, facet),
                    0.5 * facet_area_ratio(surface, facet) / kPi};
  }
  return disks;
}

Estimate estimate_disk_robust(const Surface& surface, const DiskRobustOptions& options) {
  const RobustPasses passes(surface, options);
  Estimate estimate;
  estimate.kind = AoKind::kCosine;
  estimate.ao = Grid<float>(surface.width(), surface.height());
  estimate.bent_normals = Grid<glm::vec3>(surface.width(), surface.height());

  const auto facet_passes = static_cast<uint64_t>(std::max(0, options.passes - 1));
  Progress progress("disk-robust", passes.disks.size() * facet_passes + estimate.ao.size(), "receiver");
  std::vector<double> accessibility(passes.disks.size(), 1.0);
  for (uint64_t pass = 0; pass < facet_passes; ++pass)
    estimate.work += passes.pass_over_facets(accessibility, progress);
  estimate.work += passes.pass_over_texels(accessibility, estimate, progress);
  return estimate;
}

}  // namespace hemibake
