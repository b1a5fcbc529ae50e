// The end of a ray over a surface.
#pragma once

namespace hemibake {

// kEscaped: to the sky. kHit: on the surface. kTruncated: given up at a limit of the tracer, taken for sky.
enum class RayOutcome { kEscaped, kHit, kTruncated };

}  // namespace hemibake
