// The tracer that settings ask for.
#pragma once

#include <memory>

#include "bake/load.h"
#include "tracers/tracer.h"

namespace hemibake {

// Makes the tracer of the resolved settings. `map` must outlive it. Throws std::runtime_error where Embree
// fails (out of memory).
std::unique_ptr<Tracer> make_tracer(const LoadedMap& map, const BakeSettings& settings);

// Returns the bytes that tracer will take, about.
// texels, facets: of the surface; settings: resolved.
size_t tracer_bytes(uint32_t texels, uint32_t facets, const BakeSettings& settings);

}  // namespace hemibake
