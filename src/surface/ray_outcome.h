// The end of a ray over a surface.
#pragma once

namespace hemibake {

// kEscaped: to the sky. kHit: on the surface. kTruncated: given up at a limit of the tracer, taken for sky.
// kGround: to the level ground beyond the border (Edge::kGround). kBelow: to the underside of the surface,
// through a hole, taken for sky.
enum class RayOutcome { kEscaped, kHit, kTruncated, kGround, kBelow };

// Returns whether a ray counts as one to the sky.
inline bool reaches_sky(RayOutcome outcome) {
  return outcome == RayOutcome::kEscaped || outcome == RayOutcome::kTruncated ||
         outcome == RayOutcome::kBelow;
}

}  // namespace hemibake
