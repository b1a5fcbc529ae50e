// From what a receiver sees along its slices to the links of its row.
#pragma once

#include <span>

#include "surface/surface.h"
#include "tracers/slice/slice.h"
#include "tracers/slice/walk.h"

namespace hemibake {

// What the part of a slice between two slopes adds to SliceSums.
struct SliceStretchSums {
  double uniform = 0, horizontal = 0, vertical = 0;
};
SliceStretchSums sums_between(double low_slope, double high_slope);

// Horizontal distance of what is seen of a stretch at `slope`, texels. `direction` is the azimuth's.
double stretch_distance(const Surface& surface, const VisibleInterval& stretch, double slope,
                        glm::dvec2 direction);

// The piece of a stretch nearer than `max_distance` texels along the ray; nothing where low ≥ high.
// `direction` is the azimuth's.
VisibleInterval clip_stretch(const Surface& surface, const VisibleInterval& stretch, glm::dvec2 direction,
                             double max_distance);

// Appends hits that stand for all of a stretch, as finely as a walk samples. `start` is the receiver's place
// in texels; `rim` is the lowest slope the receiver sees at this azimuth.
void append_hits(const Surface& surface, const VisibleInterval& stretch, glm::dvec2 start,
                 glm::dvec2 direction, double rim, float hits_per_weight, std::vector<SliceHit>& hits);

// Appends the links of a hit worth `weight`. choice: in [0, 1), which node of a facet is drawn.
void append_links(const Surface& surface, const PatchSet& patches, TexelLinks texel_links,
                  const SliceHit& hit, double weight, double choice, std::vector<FormFactor>& links);

}  // namespace hemibake
