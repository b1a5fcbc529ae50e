#include "estimators/disk.h"

#include "core/error.h"
#include "estimators/disk_passes.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

bool is_self(const DiskNode& node, size_t receiver, bool own_copy) {
  return own_copy && node.element == receiver;
}

}  // namespace

std::vector<Disk> vertex_disks(const Surface& surface, VertexArea vertex_area) {
  std::vector<Disk> disks(surface.texel_count(), {glm::dvec3(0), glm::dvec3(0), 0});
  std::vector<int> shared_by(disks.size(), 0);
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
    const glm::dvec3 normal = facet_normal(surface, facet);
    const double area = 0.5 * facet_area_ratio(surface, facet);
    for (const glm::ivec2 corner : facet_corners(surface, facet).texel) {
      const size_t texel = surface.heights_m.index(corner.x % surface.width(), corner.y % surface.height());
      disks[texel].normal += normal;
      disks[texel].area_over_pi += area / kPi;
      ++shared_by[texel];
    }
  }
  for (size_t texel = 0; texel < disks.size(); ++texel) {
    const int x = static_cast<int>(texel) % surface.width(), y = static_cast<int>(texel) / surface.width();
    disks[texel].position = {x, y, surface.heights_m[texel] / surface.texel_size_m};
    disks[texel].normal = glm::normalize(disks[texel].normal);
    disks[texel].area_over_pi /= vertex_area == VertexArea::kThirdOfEach ? 3 : shared_by[texel];
  }
  return disks;
}

Estimate estimate_disk(const Surface& surface, const DiskOptions& options) {
  const std::vector<Disk> disks = vertex_disks(surface, options.vertex_area);
  const DiskTree tree = make_grid_tree(disks, surface.width(), surface.height());
  const DiskReach reach = make_disk_reach(surface, options.opening_ratio, options.radius_m);
  Estimate estimate;
  estimate.ao = Grid<float>(surface.width(), surface.height());
  estimate.bent_normals = Grid<glm::vec3>(surface.width(), surface.height());

  Progress progress("disk", disks.size() * static_cast<uint64_t>(options.passes), "texel");
  std::vector<double> accessibility(disks.size(), 1.0);
  for (int pass = 0; pass < options.passes; ++pass) {
    const std::vector<double> emitters = values_of_nodes(tree, accessibility);
    estimate.work += for_each_receiver(disks.size(), progress, [&](size_t texel) {
      const glm::dvec3 normal(surface.normals[texel]);
      ShadowSum shadows;
      const auto add_shadow = [&](uint32_t i, const glm::dvec3& offset, bool own_copy) {
        if (is_self(tree[i], texel, own_copy)) return;
        const Disk& disk = tree[i].disk;
        const double shadow = disk_shadow(offset, disk.normal, disk.area_over_pi, normal, options.side);
        if (shadow > 0) shadows.add(shadow * emitters[i], offset);
      };
      const uint64_t visited = visit_disks(tree, reach, disks[texel].position, add_shadow);
      accessibility[texel] = shadows.accessibility();
      estimate.bent_normals[texel] = glm::vec3(shadows.bent_normal(normal));
      return visited;
    });
  }
  for (size_t texel = 0; texel < disks.size(); ++texel)
    estimate.ao[texel] = static_cast<float>(accessibility[texel]);
  return estimate;
}

std::vector<Grid<float>> disk_light(const Surface& surface, const Grid<float>& direct_irradiance,
                                    const DiskOptions& options, const DiskLightOptions& light) {
  expect_equal(direct_irradiance.size(), surface.heights_m.size(), "texels of the direct irradiance");
  const std::vector<Disk> disks = vertex_disks(surface, options.vertex_area);
  const DiskTree tree = make_grid_tree(disks, surface.width(), surface.height());
  const DiskReach reach = make_disk_reach(surface, options.opening_ratio, options.radius_m);

  // Returns Σ F · values of each receiver over the disks whose `side` faces it.
  Progress progress(
      "disk light",
      disks.size() * static_cast<uint64_t>(light.bounces) * static_cast<uint64_t>(light.shadow_passes + 1),
      "texel");
  const auto transfer = [&](const std::vector<double>& values, OccluderSide side) {
    const std::vector<double> emitters = values_of_nodes(tree, values);
    std::vector<double> received(disks.size());
    for_each_receiver(disks.size(), progress, [&](size_t texel) {
      const glm::dvec3 normal(surface.normals[texel]);
      double sum = 0;
      const auto add_light = [&](uint32_t i, const glm::dvec3& offset, bool own_copy) {
        if (is_self(tree[i], texel, own_copy)) return;
        const Disk& disk = tree[i].disk;
        sum += disk_form_factor(offset, disk.normal, disk.area_over_pi, normal, side) * emitters[i];
      };
      const uint64_t visited = visit_disks(tree, reach, disks[texel].position, add_light);
      received[texel] = sum;
      return visited;
    });
    return received;
  };

  std::vector<Grid<float>> irradiance{direct_irradiance};
  std::vector<double> emitted(direct_irradiance.values.begin(), direct_irradiance.values.end());
  for (int bounce = 1; bounce <= light.bounces; ++bounce) {
    const std::vector<double> unshadowed = transfer(emitted, OccluderSide::kFront);
    std::vector<double> received = unshadowed;
    for (int pass = 0; pass < light.shadow_passes; ++pass) {
      const std::vector<double> caught = transfer(received, OccluderSide::kBack);
      for (size_t i = 0; i < received.size(); ++i) received[i] = std::max(0.0, unshadowed[i] - caught[i]);
    }
    emitted = received;
    irradiance.emplace_back(surface.width(), surface.height());
    for (size_t i = 0; i < emitted.size(); ++i) irradiance.back()[i] = static_cast<float>(emitted[i]);
  }
  return irradiance;
}

}  // namespace hemibake
