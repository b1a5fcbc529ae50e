// Makes the result of bounce_light for no bounces, in a few planes of memory.
#pragma once

#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Returns E₀ of every texel as irradiance and total. transport: form factors are not needed.
Bounces direct_light(const LightTransport& transport);

}  // namespace hemibake
