// Takes the next step of a path: the same for every path tracer of this folder.
#pragma once

#include <cstdint>

#include "reference/random.h"
#include "reference/ray_caster.h"

namespace hemibake {

struct PathStep {
  RayOutcome outcome;    // kHit, kEscaped or kTruncated
  glm::dvec3 direction;  // unit
  SurfacePoint hit;      // where the path goes on, if it hits
  uint32_t rays;         // cast
};

// Directions drawn anew, at most, where the ground beyond the border is met.
inline constexpr uint32_t kMostDraws = 256;

// Casts a cosine-distributed ray. The ground beyond the border (Edge::kGround) looks as what else of the
// surface is seen from the same point: the direction is drawn anew until it hits, and the path stays where it
// is if none does.
// lift: of the start, texels.
inline PathStep step_path(const HeightFieldRayCaster& caster, const SurfacePoint& from, double lift,
                          RefereeRandom& random) {
  const glm::dvec3 start(from.position.x, from.position.y, from.position.z + lift);
  PathStep step{RayOutcome::kGround, {}, from, 0};
  while (step.rays < kMostDraws) {
    step.direction = random_cosine_direction(from.normal, random);
    step.outcome = caster.cast(start, step.direction, step.hit);
    const bool first = step.rays++ == 0;
    if (step.outcome == RayOutcome::kHit || (first && reaches_sky(step.outcome))) return step;
  }
  step.outcome = RayOutcome::kHit;
  return step;
}

}  // namespace hemibake
