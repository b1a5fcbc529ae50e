// A surface traced with few slices, for tests of what is done with its form factors.
#pragma once

#include "surface/surface.h"
#include "tracers/slice/slice.h"
#include "transport/trace_surface.h"

namespace hemibake {

inline LightTransport sliced(const Surface& surface) {
  SliceOptions options;
  options.azimuths = 8;
  return trace_surface(*make_slice_tracer(surface, options), KeptLinks::kAll);
}

}  // namespace hemibake
