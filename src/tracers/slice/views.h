// Traces packets and completes what their receivers see: hits of receivers that have none, and views that end
// at a maximum distance.
#pragma once

#include <span>

#include "tracers/slice/slice_scene.h"
#include "tracers/slice/traversal.h"

namespace hemibake {

// Share of the light; a smaller blocked one counts as none: a tenth of a horizon's error.
inline constexpr double kLeastBlocked = 1e-5;

// Traces packets of one family; the views, one per receiver, are valid until this thread's next call.
std::span<const PacketView> trace_views(const SliceScene& scene, const SlicePaths& paths, Query query,
                                        const SlicePackets& packets);

}  // namespace hemibake
