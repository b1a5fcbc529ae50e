#include "tracers/slice/traversal.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sampling/low_discrepancy.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracers/slice/traversal.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// Must come after highway.h.
#include "tracers/slice/path_traversal-inl.h"

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {

// Returns i modulo n, for i not far from 0..n-1.
inline int wrap_near(int i, int n) {
  if (i < 0) i += n;
  while (i >= n) i -= n;
  return i;
}

HWY_INLINE void PathTraversal::find_intervals(const SlicePacket& packet, uint32_t azimuth, int segment,
                                              Lanes& lanes, PacketView& view) {
  for_each_crossing(
      packet, segment, lanes,
      [&](size_t p, V slope, const glm::ivec2& corner, const Crossing& crossing, const FacetBefore& facet)
          HWY_ATTR {
            if (hn::AllTrue(kF, hn::Le(slope, lanes.slope.part[p]))) return;
            const V above = cosine_above(slope, lanes.tangent_slope.part[p]);
            // Intervals that vanish by rounding merge into the next.
            const auto seen = hn::And(hn::Gt(slope, lanes.slope.part[p]), hn::Lt(above, lanes.above.part[p]));
            alignas(64) float low[kWidth], high[kWidth], weight[kWidth];
            hn::Store(lanes.slope.part[p], kF, low);
            hn::Store(slope, kF, high);
            hn::Store(hn::Sub(lanes.above.part[p], above), kF, weight);
            lanes.slope.part[p] = hn::IfThenElse(seen, slope, lanes.slope.part[p]);
            lanes.above.part[p] = hn::IfThenElse(seen, above, lanes.above.part[p]);
            for_each_lane(seen, [&](size_t l) {
              const size_t lane = p * kWidth + l;
              view.intervals[lane].push_back({facet_at(corner, facet, static_cast<int>(lane)), weight[l],
                                              low[l], high[l], crossing.inverse_distance, azimuth});
            });
          });
}

// Places the hits of all receivers that are sampled along this azimuth, and returns whether there are any.
HWY_INLINE bool PathTraversal::place_all_hits(std::span<const SliceReceivers> receivers, uint32_t azimuth,
                                              const Vectors& horizon) {
  const uint32_t stride = static_cast<uint32_t>(options_.hit_azimuth_stride);
  const V shift = hn::Set(kF, static_cast<float>(radical_inverse(2, azimuth / stride)));
  for (int& rows : hits_.rows) rows = 0;
  for (uint32_t r = azimuth % stride; r < receivers.size(); r += stride) {
    const Vectors offset = load(receivers[r].hit_offset), per_weight = load(receivers[r].hits_per_weight);
    const Vectors tangent = tangent_slope(receivers[r]), slope = above_tangent(receivers[r], horizon);
    for (size_t p = 0; p < kParts; ++p) {
      const V sum = hn::Add(offset.part[p], shift);
      const int first = hits_.rows[p];
      place_hits(p, tangent.part[p], slope.part[p], per_weight.part[p], hn::Sub(sum, hn::Floor(sum)),
                 static_cast<float>(r), hits_);
      hits_.merge(p, first);
    }
  }
  int most = 0;
  for (size_t p = 0; p < kParts; ++p) {
    hn::Store(hn::Set(kF, kUnreachable), kF, hits_.slope[hits_.rows[p]] + p * kWidth);
    most = std::max(most, hits_.rows[p]);
  }
  return most > 0;
}

// Finds the sampled hits of the slice below the horizon by following the path again.
HWY_INLINE void PathTraversal::find_hits(const SlicePacket& packet, std::span<const SliceReceivers> receivers,
                                         uint32_t azimuth, Lanes& lanes, std::span<PacketView> views) {
  if (!place_all_hits(receivers, azimuth, lanes.slope)) return;
  next_hit_ = {};
  for (size_t p = 0; p < kParts; ++p) lanes.slope.part[p] = hn::Load(kF, hits_.slope[0] + p * kWidth);
  for (int segment = 0;;) {
    if (!reaches_map(packet, segment) || segment > last_segment_) return;
    if (segment > 0) {
      if (hits_are_final(lanes, segment)) return;
      const int skipped = segments_to_skip(packet, lanes, segment);
      segment += skipped;
      if (skipped > 0) continue;
    }
    find_segment_hits(packet, segment, lanes, views);
    ++segment;
  }
}

// Returns whether no lane can meet its next hit from `segment` on. A little below a slope of zero, a hit on a
// wrapping map may be arbitrarily far away.
HWY_INLINE bool PathTraversal::hits_are_final(const Lanes& lanes, int segment) const {
  const V near = hn::Set(kF, inverse_distance(segment)), zero = hn::Zero(kF);
  bool all = true;
  for (size_t p = 0; p < kParts; ++p) {
    const V next = lanes.slope.part[p];
    const auto level = hn::And(hn::Ge(next, hn::Set(kF, -kHitTolerance)), hn::Lt(next, zero));
    const V enough = hn::IfThenElse(level, hn::Set(kF, kHorizonTolerance), next);
    all = all && hn::AllTrue(kF, hn::Lt(hn::Mul(lanes.to_top.part[p], near), enough));
  }
  return all;
}

HWY_INLINE void PathTraversal::find_segment_hits(const SlicePacket& packet, int segment, Lanes& lanes,
                                                 std::span<PacketView> views) {
  const SlicePath& path = segments_.path();
  const V near = broadcast(segment * path.step), zero = hn::Zero(kF), one = hn::Set(kF, 1.0f);
  const glm::vec2 begin(segment_begin(path, segment)), direction(path.direction);
  const glm::ivec2 window = window_in_map(packet, segments_.corner(segment, 0));
  const float* heights = pyramid_.heights.at(window.x, window.y);
  const V least = broadcast(segment == 0 ? options_.least_distance : 0);
  for_each_crossing(
      packet, segment, lanes,
      [&](size_t p, V slope, const glm::ivec2& corner, const Crossing& crossing, const FacetBefore& facet)
          HWY_ATTR {
            auto hit = hn::Ge(slope, lanes.slope.part[p]);
            if (hn::AllFalse(kF, hit)) return;
            const Crossing& entry = (&crossing)[-1];
            const V entered = hn::Set(kF, (&facet)[-1].along), left = hn::Set(kF, facet.along);
            // Heights over the start at which the path enters and leaves the facet.
            const V near_height = height_at(entry, heights, p, lanes), near_distance = hn::Add(near, entered);
            const V far_height = height_at(crossing, heights, p, lanes), far_distance = hn::Add(near, left);
            do {
              // Heights of the ray above the facet where it enters, and below it where it leaves.
              const V next = lanes.slope.part[p];
              const V above = hn::Max(zero, mul_sub(next, near_distance, near_height));
              const V below = hn::Max(hn::Set(kF, 1e-30f), neg_mul_add(next, far_distance, far_height));
              const V exact = mul_add(hn::Div(above, hn::Add(above, below)), hn::Sub(left, entered), entered);
              const V along = hn::Max(exact, hn::Min(left, least));
              const V distance = hn::Mul(hn::Add(near, along), hn::Sqrt(mul_add(next, next, one)));
              alignas(64) float slopes[kWidth], alongs[kWidth], distances[kWidth];
              hn::Store(next, kF, slopes);
              hn::Store(along, kF, alongs);
              hn::Store(distance, kF, distances);
              for_each_lane(hit, [&](size_t l) {
                const size_t lane = p * kWidth + l;
                const auto receiver = static_cast<size_t>(hits_.receiver[next_hit_[lane]][lane]);
                const size_t next_hit = ++next_hit_[lane];
                const glm::vec2 in_cell = begin + alongs[l] * direction - glm::vec2(facet.column, facet.row);
                const glm::vec2 uv = !facet.half ? in_cell : 1.0f - in_cell;
                views[receiver].hits[lane].push_back(
                    {facet_at(corner, facet, static_cast<int>(lane)), 1, uv.x, uv.y, distances[l]});
                slopes[l] = hits_.slope[next_hit][lane];
              });
              lanes.slope.part[p] = hn::Load(kF, slopes);
              hit = hn::Ge(slope, lanes.slope.part[p]);
            } while (!hn::AllFalse(kF, hit));
          });
}

HWY_INLINE uint32_t PathTraversal::facet_at(glm::ivec2 corner, const FacetBefore& facet, int lane) const {
  int column = corner.x + facet.column + lane, row = corner.y + facet.row, columns = pyramid_.width;
  if (pyramid_.wrap) {
    column = wrap_near(column, pyramid_.width);
    row = wrap_near(row, pyramid_.height);
  } else {
    // Paths along the border run beside the last cells.
    columns = pyramid_.width - 1;
    column = std::clamp(column, 0, columns - 1);
    row = std::clamp(row, 0, pyramid_.height - 2);
  }
  const uint32_t cell =
      static_cast<uint32_t>(row) * static_cast<uint32_t>(columns) + static_cast<uint32_t>(column);
  return 2 * cell + (facet.half ? 1 : 0);
}

// Adds the unblocked hemisphere of receivers along all azimuths of their packet's rotation.
void add_hemisphere(const SlicePaths& paths, int rotation, const SliceReceivers& receivers,
                    SliceSums& hemisphere) {
  for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
    const glm::dvec2& direction = paths.paths[paths.path_index(rotation, azimuth)].direction;
    add_sky(along(receivers.tangent_slope_x, receivers.tangent_slope_y, direction.x, direction.y), direction,
            hemisphere);
  }
}

template <Query kQuery>
void traverse_all(const HeightPyramid& pyramid, const SlicePaths& paths, const TraversalOptions& options,
                  const SlicePackets& given, std::span<PacketView> views) {
  const std::span<const SlicePacket> packets = given.packets;
  // Path after path, so that its crossings and heights stay in the caches.
  std::vector<size_t> order(packets.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return packets[a].rotation < packets[b].rotation; });
  for (const SlicePacket& packet : packets)
    for (uint32_t r = packet.first_receiver; r < packet.first_receiver + packet.receivers; ++r)
      add_hemisphere(paths, packet.rotation, given.receivers[r], views[r].hemisphere);
  PathTraversal traversal(pyramid, paths, options);
  for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
    int rotation = -1;
    for (const size_t index : order) {
      const SlicePacket& packet = packets[index];
      if (packet.rotation != rotation) {
        rotation = packet.rotation;
        traversal.begin_path(paths.path_index(rotation, azimuth));
      }
      // Intervals begin at the tangent plane of one receiver.
      const uint32_t step = kQuery == Query::kAllIntervals ? 1 : packet.receivers;
      const uint32_t end = packet.first_receiver + packet.receivers;
      for (uint32_t first = packet.first_receiver; first < end; first += step)
        traversal.trace<kQuery>(packet, given.receivers.subspan(first, step), static_cast<uint32_t>(azimuth),
                                views.subspan(first, step));
    }
  }
}

void traverse_packets(const HeightPyramid& pyramid, const SlicePaths& paths, const TraversalOptions& options,
                      const SlicePackets& packets, std::span<PacketView> views) {
  switch (options.query) {
    case Query::kHorizon:
      return traverse_all<Query::kHorizon>(pyramid, paths, options, packets, views);
    case Query::kSampledHits:
      return traverse_all<Query::kSampledHits>(pyramid, paths, options, packets, views);
    case Query::kAllIntervals:
      return traverse_all<Query::kAllIntervals>(pyramid, paths, options, packets, views);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hemibake {

HWY_EXPORT(traverse_packets);

void traverse_packets(const HeightPyramid& pyramid, const SlicePaths& paths, const TraversalOptions& options,
                      const SlicePackets& packets, std::span<PacketView> views) {
  HWY_DYNAMIC_DISPATCH(traverse_packets)(pyramid, paths, options, packets, views);
}

}  // namespace hemibake
#endif  // HWY_ONCE
