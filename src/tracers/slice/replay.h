// Lists the view of a texel along its slices, interval by interval.
#pragma once

#include <vector>

#include "surface/surface.h"
#include "tracers/slice/traversal.h"
#include "tracers/tracer.h"

namespace hemibake {

// Returns one record per interval that a lane of a packet of texels sees, and one per azimuth for its sky:
// the whole that form factors are a sample of; ground beyond the border is in none. view: traced with
// Query::kAllIntervals.
std::vector<RayRecord> replay_slices(const Surface& surface, const SlicePaths& paths,
                                     const SlicePacket& packet, const SliceReceivers& receivers,
                                     const PacketView& view, size_t lane);

}  // namespace hemibake
