// Estimates ambient occlusion and indirect light between disks at the vertices of the surface: M. Bunnell,
// "Dynamic Ambient Occlusion and Indirect Lighting", GPU Gems 2, ch. 14, 2005.
//
// Every texel is an element: its position, the average of the normals of the facets that share it, and their
// area. The first pass adds up the shadows of all others and is too dark where shadows overlap; every further
// pass weighs an emitter by its own accessibility in the pass before. Deviations: fronts occlude
// (form_factors.h says why), and the receiver's normal is the texel's shading normal, about which the truth
// is measured too.
#pragma once

#include <vector>

#include "estimators/disk_tree.h"
#include "estimators/estimate.h"
#include "estimators/form_factors.h"

namespace hemibake {

// Area of a vertex: a third of each of its facets (so that all add up to the surface; GPU Gems 2), or their
// average.
enum class VertexArea { kThirdOfEach, kAverage };

struct DiskOptions {
  int passes = 2;              // 1..
  double opening_ratio = 0.2;  // a node stands for its children below this size over distance; 0: brute force
  double radius_m = 0;         // farther disks do not count; 0: see make_disk_reach
  OccluderSide side = OccluderSide::kFront;
  VertexArea vertex_area = VertexArea::kThirdOfEach;
};

// Returns one disk per texel, in texels.
std::vector<Disk> vertex_disks(const Surface& surface, VertexArea vertex_area);

// Estimates AO, about uniform. Bent normals: the normal less every shadow's direction times its size.
Estimate estimate_disk(const Surface& surface, const DiskOptions& options);

struct DiskLightOptions {
  int bounces = 4;        // 0..
  int shadow_passes = 1;  // 0: light goes through everything
};

// Estimates E_0 … E_bounces at albedo 1 per texel by disk-to-disk radiance transfer, comparable with the
// bake's: E_{b+1} = Σ F E_b over the disks whose front faces the receiver, F of disk_form_factor. A shadow
// pass then subtracts the light that disks in between catch: Σ F L over those whose back faces the receiver,
// L the light of the pass before; never below 0. The sums are not bounded by π: overlapping disks send more
// light than there is. direct_irradiance: E_0 per texel, 0..π.
std::vector<Grid<float>> disk_light(const Surface& surface, const Grid<float>& direct_irradiance,
                                    const DiskOptions& disks, const DiskLightOptions& light);

}  // namespace hemibake
