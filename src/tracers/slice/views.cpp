#include "tracers/slice/views.h"

#include <cmath>
#include <utility>
#include <vector>

#include "tracers/slice/intervals.h"

namespace hemibake {
namespace {

// Hits wanted of a receiver that would have none.
constexpr double kFewestHits = 8;

// Returns the lanes that have no hits and yet are blocked, as receivers whose slices are sampled more
// densely.
SliceReceivers missed_lanes(const SliceReceivers& receivers, const PacketView& view) {
  SliceReceivers missed = receivers;
  missed.lanes = 0;
  for (size_t lane = 0; lane < kSliceLanes; ++lane) {
    if ((receivers.lanes >> lane & 1) == 0 || !view.hits[lane].empty()) continue;
    const double whole = cosine_sum(receivers, view.hemisphere, lane);
    const double blocked = whole - cosine_sum(receivers, view.sky, lane);
    if (blocked < kLeastBlocked * whole) continue;
    missed.hits_per_weight[lane] = static_cast<float>(kFewestHits / blocked);
    missed.lanes |= 1u << lane;
  }
  return missed;
}

// Traces lanes again, along all azimuths, that have no hits and yet are blocked.
void resample_missed_hits(const SliceScene& scene, const SlicePaths& paths, SlicePacket packet,
                          std::span<const SliceReceivers> receivers, std::span<PacketView> views) {
  std::vector<SliceReceivers> missed;
  std::vector<size_t> whose;
  for (size_t r = 0; r < receivers.size(); ++r) {
    missed.push_back(missed_lanes(receivers[r], views[r]));
    if (missed.back().lanes == 0) {
      missed.pop_back();
    } else {
      whose.push_back(r);
    }
  }
  if (missed.empty()) return;
  packet.first_receiver = 0;
  packet.receivers = static_cast<uint32_t>(missed.size());
  std::vector<PacketView> again(missed.size());
  traverse_packets(scene.pyramid, paths,
                   {.query = Query::kSampledHits, .least_distance = paths.least_distance},
                   {{&packet, 1}, missed}, again);
  for (size_t i = 0; i < missed.size(); ++i)
    for (size_t lane = 0; lane < kSliceLanes; ++lane)
      if ((missed[i].lanes >> lane & 1) != 0) views[whose[i]].hits[lane] = std::move(again[i].hits[lane]);
}

// Clips intervals to the maximum distance, adds the rest to the sky, and fills the hits.
void clip_to_max_distance(const SliceScene& scene, const SlicePaths& paths, const SlicePacket& packet,
                          const SliceReceivers& receivers, PacketView& view) {
  for (size_t lane = 0; lane < kSliceLanes; ++lane) {
    std::vector<VisibleInterval> near_intervals;
    for (const VisibleInterval& interval : view.intervals[lane]) {
      const SlicePath& path =
          paths.paths[paths.path_index(packet.rotation, static_cast<int>(interval.azimuth))];
      const SliceRay slice{glm::dvec2(packet.x + static_cast<int>(lane), packet.y) + path.origin,
                           path.direction,
                           static_cast<double>(receivers.tangent_slope_x[lane]) * path.direction.x +
                               static_cast<double>(receivers.tangent_slope_y[lane]) * path.direction.y};
      VisibleInterval near =
          clip_interval(scene.surface, interval, slice.direction, scene.max_distance_texels());
      const IntervalIntegrals all =
          integrate_interval(static_cast<double>(interval.low), static_cast<double>(interval.high));
      const IntervalIntegrals part =
          integrate_interval(static_cast<double>(near.low), static_cast<double>(near.high));
      view.sky.uniform[lane] += all.uniform - part.uniform;
      view.sky.x[lane] += slice.direction.x * (all.horizontal - part.horizontal);
      view.sky.y[lane] += slice.direction.y * (all.horizontal - part.horizontal);
      view.sky.z[lane] += all.vertical - part.vertical;
      near.weight = static_cast<float>(part.cosine(slice.tangent_slope));
      if (near.weight <= 0) continue;
      near_intervals.push_back(near);
      append_hits(scene.surface, near, slice, receivers.hits_per_weight[lane], view.hits[lane]);
    }
    view.intervals[lane] = std::move(near_intervals);
  }
}

}  // namespace

std::span<const PacketView> trace_views(const SliceScene& scene, const SlicePaths& paths, Query query,
                                        const SlicePackets& packets) {
  thread_local std::vector<PacketView> scratch;  // keeps its memory
  scratch.resize(std::max(scratch.size(), packets.receivers.size()));
  const std::span<PacketView> views(scratch.data(), packets.receivers.size());
  for (PacketView& view : views) clear(view);
  const bool limited = std::isfinite(scene.max_distance_texels());
  const bool sampled = query == Query::kSampledHits && !limited;
  traverse_packets(scene.pyramid, paths,
                   {limited ? Query::kAllIntervals : query, sampled ? paths.hit_azimuth_stride : 1,
                    scene.max_distance_texels(), paths.least_distance},
                   packets, views);
  for (const SlicePacket& packet : packets.packets) {
    const auto receivers = packets.receivers.subspan(packet.first_receiver, packet.receivers);
    const auto their_views = views.subspan(packet.first_receiver, packet.receivers);
    if (sampled) resample_missed_hits(scene, paths, packet, receivers, their_views);
    for (size_t r = 0; limited && r < receivers.size(); ++r)
      clip_to_max_distance(scene, paths, packet, receivers[r], their_views[r]);
  }
  return views;
}

}  // namespace hemibake
