// Closed forms and hits of the intervals that a receiver sees along its slices.
#pragma once

#include <vector>

#include "surface/surface.h"
#include "tracers/slice/traversal.h"

namespace hemibake {

// Contribution of a part of a slice to SliceSums.
struct IntervalIntegrals {
  double uniform = 0, horizontal = 0, vertical = 0;

  // Returns ∫ cosine to the receiver's normal, over normal.z.
  double cosine(double tangent_slope) const { return vertical - tangent_slope * horizontal; }
};

// Integrates a slice from one slope to another.
IntervalIntegrals integrate_interval(double low_slope, double high_slope);

// A slice of a receiver.
struct SliceRay {
  glm::dvec2 start;      // of the receiver, texels
  glm::dvec2 direction;  // of the azimuth, unit
  double tangent_slope;  // lowest slope that the receiver sees
};

// Returns the horizontal distance, in texels, of an interval's point at `slope`. direction: of the azimuth.
double interval_distance(const Surface& surface, const VisibleInterval& interval, double slope,
                         glm::dvec2 direction);

// Returns the part of an interval nearer than `max_distance` texels along the ray; empty where low ≥ high.
// direction: of the azimuth.
VisibleInterval clip_interval(const Surface& surface, const VisibleInterval& interval, glm::dvec2 direction,
                              double max_distance);

// Appends hits that stand for all of an interval, at least one per 1 / hits_per_weight of its weight.
void append_hits(const Surface& surface, const VisibleInterval& interval, const SliceRay& slice,
                 float hits_per_weight, std::vector<SliceHit>& hits);

}  // namespace hemibake
