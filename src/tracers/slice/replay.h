// What a texel sees along its slices, piece by piece.
#pragma once

#include <vector>

#include "surface/surface.h"
#include "tracers/slice/walk.h"
#include "tracers/tracer.h"

namespace hemibake {

// One record per stretch seen by a lane of a packet of texels, and one per azimuth for its sky: all of what
// the links are a sample of. `view` has stretches.
std::vector<RayRecord> replay_slices(const Surface& surface, const SlicePaths& paths,
                                     const SlicePacket& packet, const PacketView& view, size_t lane);

}  // namespace hemibake
