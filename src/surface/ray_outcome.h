// How a ray over a surface ends.
#pragma once

namespace hemibake {

// kEscaped: to the sky. kHit: on the surface. kTruncated: the tracer stopped following it, and takes it for
// sky; each tracer says where that is.
enum class RayOutcome { kEscaped, kHit, kTruncated };

}  // namespace hemibake
