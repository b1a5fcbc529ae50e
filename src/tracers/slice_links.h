// From the stretches of surface that a receiver sees along its slices to the links of its row.
#pragma once

#include <span>

#include "surface/surface.h"
#include "tracers/slice.h"
#include "tracers/slice_walk.h"

namespace hemibake {

// What the part of a slice between two slopes adds to SliceSums.
struct SliceStretchSums {
  double uniform = 0, horizontal = 0, vertical = 0;
};
SliceStretchSums sums_between(double low_slope, double high_slope);

// Horizontal distance, texels, at which a slope between low and high meets the stretch.
double stretch_distance(const Surface& surface, const Stretch& stretch, glm::dvec2 direction, double slope);

// The piece of a stretch nearer than `max_distance` texels along the ray; nothing where low ≥ high.
// `direction` is the azimuth's.
Stretch clip_stretch(const Surface& surface, const Stretch& stretch, glm::dvec2 direction,
                     double max_distance);

// Appends the links of a stretch worth `weight`. Where patches are texels, a stretch longer than half a texel
// is split; `start` is the receiver's place in texels, `rim` the lowest slope it sees at this azimuth.
void append_stretch_links(const Surface& surface, const SliceOptions& options, const Stretch& stretch,
                          double weight, double rim, glm::dvec2 start, glm::dvec2 direction,
                          std::vector<Link>& links);

}  // namespace hemibake
