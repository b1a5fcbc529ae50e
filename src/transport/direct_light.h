// The light of no bounce at all: what bounce_light gives for it, in a few planes of memory.
#pragma once

#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {

// E₀ of every texel as irradiance and total.
Bounces direct_light(const LightTransport& seen);

}  // namespace hemibake
