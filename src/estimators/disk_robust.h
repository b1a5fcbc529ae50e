// Estimates ambient occlusion between disks on the facets, the last pass with exact polygons: J. Hoberock, Y.
// Jia, "High-Quality Ambient Occlusion", GPU Gems 3, ch. 12, 2007.
//
// All passes but the last find the accessibility of every facet from disk-to-disk form factors, an emitter
// weighed by its accessibility in the pass before. The last finds that of every texel: nodes that stand for
// many facets still count as disks, single facets as triangles clipped by the receiver's plane, with their
// exact form factor. The receiver is lifted vertically as the rays of the truth are. Fronts occlude
// (form_factors.h says why).
#pragma once

#include <vector>

#include "estimators/disk_tree.h"
#include "estimators/estimate.h"
#include "estimators/form_factors.h"

namespace hemibake {

struct DiskRobustOptions {
  int passes = 3;              // the last one included, 1..
  double opening_ratio = 0.2;  // as in DiskOptions
  double radius_m = 0;         // as in DiskOptions
  OccluderSide side = OccluderSide::kFront;
  bool robust = true;                     // false: disks in the last pass too
  double distance_attenuation_per_m = 0;  // a_D: a shadow at distance d is divided by 1 + a_D d
  double triangle_attenuation = 1;        // a_T: the last pass multiplies by accessibility^a_T; 0: by nothing
};

// Returns one disk per facet at its centroid, in texels.
std::vector<Disk> facet_disks(const Surface& surface);

// Estimates cosine-weighted AO. Bent normals as of estimate_disk.
Estimate estimate_disk_robust(const Surface& surface, const DiskRobustOptions& options);

}  // namespace hemibake
