#include "tracers/slice/walk.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sampling/low_discrepancy.h"
#include "tracers/slice/segments.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracers/slice/walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// Must come after highway.h.
#include "tracers/slice/hits-inl.h"

#ifndef HEMIBAKE_SLICE_WALK_ONCE
#define HEMIBAKE_SLICE_WALK_ONCE
namespace hemibake {

// Slopes: an azimuth ends where no more than this can be gained.
constexpr float kHorizonTolerance = 1e-4f;
// The same below a slope of zero, where a wrapping map blocks everything and only the links are still to be
// found.
constexpr float kLinkTolerance = 1e-3f;
// Longer sides of the map after which a walk ends in any case.
constexpr double kFarthestMaps = 1e4;
// From here on the heights of a segment are seldom in the nearest cache.
constexpr int kColdSegments = 16;

// i modulo n for i not far from 0..n-1.
inline int wrap_near(int i, int n) {
  if (i < 0) i += n;
  while (i >= n) i -= n;
  return i;
}

}  // namespace hemibake
#endif

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
// One path at a time, for packet after packet.
class PathWalk {
 public:
  PathWalk(const HeightPyramid& field, const SlicePaths& paths, const WalkOptions& options)
      : field_(field), options_(options), segments_(field, paths) {
    const double farthest = kFarthestMaps * std::max({field.width, field.height, kSegmentCells});
    last_segment_ = static_cast<int>(std::min(farthest, options.max_distance) / kSegmentCells);
    blocks_below_ = field.wrap && std::isinf(options.max_distance);
  }

  void begin_path(size_t index) {
    segments_.begin_path(index);
    inverse_step_ = static_cast<float>(1 / segments_.path().step);
  }

  // Adds what the packet sees along the path.
  template <Query kWhat>
  void walk(const SlicePacket& packet, uint32_t azimuth, PacketView& view) {
    const SlicePath& path = segments_.path();
    Lanes lanes = start(packet);
    for (int segment = 0;;) {
      if (!reaches_map(packet, segment)) break;
      if (segment > last_segment_) {
        if (blocks_below_) count_cut_short(lanes, segment, view);
        break;
      }
      if (segment > 0) {
        if (ended(lanes, segment)) break;
        const int skipped = segments_to_skip(packet, lanes, segment);
        segment += skipped;
        if (skipped > 0) continue;
      }
      if constexpr (kWhat == Query::kAllIntervals) {
        find_stretches(packet, azimuth, segment, lanes, view);
      } else {
        raise_horizon(packet, segment, lanes);
      }
      ++segment;
    }
    if (blocks_below_)
      for (V& slope : lanes.slope.part) slope = hn::Max(slope, hn::Zero(kF));
    add_sky(lanes.slope, path.direction, view.sky);
    if constexpr (kWhat == Query::kSampledHits) find_hits(packet, azimuth, lanes, view);
  }

 private:
  Lanes start(const SlicePacket& packet) const;
  bool ended(const Lanes& lanes, int segment) const;
  void count_cut_short(const Lanes& lanes, int segment, PacketView& view) const;
  int segments_to_skip(const SlicePacket& packet, const Lanes& lanes, int segment);
  void raise_horizon(const SlicePacket& packet, int segment, Lanes& lanes);
  void find_stretches(const SlicePacket& packet, uint32_t azimuth, int segment, Lanes& lanes,
                      PacketView& view);
  void find_hits(const SlicePacket& packet, uint32_t azimuth, Lanes& lanes, PacketView& view);
  bool nothing_left(const Lanes& lanes, int segment) const;
  void meet_hits(const SlicePacket& packet, int segment, Lanes& lanes, PacketView& view);
  void fetch_window(const float* heights) const;
  template <class Meet>
  void cross_segment(const SlicePacket& packet, int segment, const Lanes& lanes, const Meet& meet);
  uint32_t facet_at(glm::ivec2 corner, const FacetBefore& facet, int lane) const;

  float inverse_distance(int segment) const { return inverse_step_ / static_cast<float>(segment); }
  glm::ivec2 place(const SlicePacket& packet, glm::ivec2 corner) const {
    int x = packet.x + corner.x, y = packet.y + corner.y;
    if (field_.wrap && x >= field_.width) x -= field_.width;
    if (field_.wrap && y >= field_.height) y -= field_.height;
    return {x, y};
  }
  bool reaches_map(const SlicePacket& packet, int segment) const {
    if (field_.wrap) return true;
    const glm::ivec2 corner = place(packet, segments_.corner(segment, 0));
    return corner.x < field_.width && corner.y < field_.height &&
           corner.x + kSliceLanes + kSegmentCells >= 0 && corner.y + kSegmentCells + 1 >= 0;
  }

  const HeightPyramid& field_;
  WalkOptions options_;
  SegmentSource segments_;
  float inverse_step_ = 0;
  int last_segment_;
  bool blocks_below_;  // a map that repeats for ever meets whatever goes down
  HitSlopes hits_;     // of the packet at hand
  LaneArray<uint8_t> next_hit_;
};

HWY_INLINE Lanes PathWalk::start(const SlicePacket& packet) const {
  const SlicePath& path = segments_.path();
  const auto corner = static_cast<double>(packet.corner);
  Lanes lanes;
  lanes.base = load(packet.base);
  lanes.rise = along(packet.plane_x, packet.plane_y, path.origin.x - corner, path.origin.y - corner);
  lanes.rim = along(packet.rim_x, packet.rim_y, path.direction.x, path.direction.y);
  const V top = hn::Set(kF, field_.top);
  for (size_t p = 0; p < kParts; ++p) {
    lanes.to_top.part[p] = hn::Sub(hn::Sub(top, lanes.base.part[p]), lanes.rise.part[p]);
    const uint32_t walked = packet.lanes >> p * kWidth;
    const uint8_t bits[8] = {static_cast<uint8_t>(walked), static_cast<uint8_t>(walked >> 8)};
    V slope = hn::IfThenElse(hn::LoadMaskBits(kF, bits), lanes.rim.part[p], hn::Set(kF, kClosed));
    if (blocks_below_ && options_.what != Query::kAllIntervals) slope = hn::Max(slope, hn::Zero(kF));
    lanes.slope.part[p] = slope;
    if (options_.what == Query::kAllIntervals) lanes.above.part[p] = cosine_above(slope, lanes.rim.part[p]);
  }
  return lanes;
}

// Whether no lane can gain more than the tolerance from `segment` on.
HWY_INLINE bool PathWalk::ended(const Lanes& lanes, int segment) const {
  const V near = hn::Set(kF, inverse_distance(segment)), low = hn::Set(kF, -kLinkTolerance);
  bool all = true;
  for (size_t p = 0; p < kParts; ++p) {
    V slope = lanes.slope.part[p];
    if (blocks_below_) slope = hn::IfThenElse(hn::Ge(slope, low), hn::Max(slope, hn::Zero(kF)), slope);
    const V enough = hn::Add(slope, hn::Set(kF, kHorizonTolerance));
    all = all && hn::AllTrue(kF, hn::Le(hn::Mul(lanes.to_top.part[p], near), enough));
  }
  return all;
}

HWY_INLINE void PathWalk::count_cut_short(const Lanes& lanes, int segment, PacketView& view) const {
  const V near = hn::Set(kF, inverse_distance(segment));
  for (size_t p = 0; p < kParts; ++p) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(kF, hn::Gt(hn::Mul(lanes.to_top.part[p], near), lanes.slope.part[p]), bits);
    for (size_t lane = 0; lane < kWidth; ++lane)
      view.truncated[p * kWidth + lane] += (bits[lane / 8] >> (lane % 8)) & 1;
  }
}

// How many segments from `segment` on stay below every lane's horizon, as far as one window tells.
HWY_INLINE int PathWalk::segments_to_skip(const SlicePacket& packet, const Lanes& lanes, int segment) {
  const V near = hn::Set(kF, inverse_distance(segment));
  for (int level = kSkipLevels - 1; level >= 0; --level) {
    const int segments = kSkipSegments[level];
    if (segment % segments != 0 || (level == 1 && segment < kFarSegments)) continue;
    const glm::ivec2 corner = place(packet, segments_.corner(segment, level));
    const HeightPlane& plane = field_.tallest[static_cast<size_t>(level)];
    const float* tallest = plane.at(corner.x, corner.y);
    const V far = hn::Set(kF, inverse_distance(segment + segments));
    bool below = true;
    for (size_t p = 0; p < kParts; ++p) {
      const V tall = plane.column_shift > 0 ? hn::Set(kF, *tallest) : hn::LoadU(kF, tallest + p * kWidth);
      const V rise = hn::Sub(hn::Sub(tall, lanes.base.part[p]), lanes.rise.part[p]);
      const V steepest = hn::Max(hn::Mul(rise, near), hn::Mul(rise, far));
      below = below && hn::AllTrue(kF, hn::Le(steepest, lanes.slope.part[p]));
    }
    if (below) return segments;
  }
  return 0;
}

// Height of a crossing over the starts. `heights`: at the first corner of the segment's window.
HWY_INLINE V height_at(const Crossing& crossing, const float* heights, size_t part, const Lanes& lanes) {
  const V a = hn::LoadU(kF, heights + crossing.a + part * kWidth);
  const V b = hn::LoadU(kF, heights + crossing.b + part * kWidth);
  const V along_edge = hn::MulSub(hn::Set(kF, crossing.fraction), hn::Sub(b, a), lanes.rise.part[part]);
  return hn::Add(hn::Sub(a, lanes.base.part[part]), along_edge);
}

// Asks for the heights of a segment's window at once.
HWY_INLINE void PathWalk::fetch_window(const float* heights) const {
  for (size_t row = 0; row < kSegmentCells + 2; ++row) {
    hwy::Prefetch(heights + row * field_.heights.pitch);
    hwy::Prefetch(heights + row * field_.heights.pitch + kSliceLanes);
  }
}

// Calls meet(part, slope, corner, crossing, facet before it) for every crossing of a segment but its first,
// by distance. The first one's are right before them in memory.
template <class Meet>
HWY_INLINE void PathWalk::cross_segment(const SlicePacket& packet, int segment, const Lanes& lanes,
                                        const Meet& meet) {
  const glm::ivec2 corner = place(packet, segments_.corner(segment, 0));
  const float* heights = field_.heights.at(corner.x, corner.y);
  if (segment >= kColdSegments) fetch_window(heights);
  const SegmentView crossed = segments_.crossings(segment);
  for (size_t i = 1; i < crossed.crossings.size(); ++i) {
    const Crossing& crossing = crossed.crossings[i];
    const V inverse = hn::Set(kF, crossing.inverse_distance);
    for (size_t p = 0; p < kParts; ++p)
      meet(p, hn::Mul(height_at(crossing, heights, p, lanes), inverse), corner, crossing, crossed.facets[i]);
  }
}

HWY_INLINE void PathWalk::raise_horizon(const SlicePacket& packet, int segment, Lanes& lanes) {
  cross_segment(packet, segment, lanes,
                [&](size_t p, V slope, const glm::ivec2&, const Crossing&, const FacetBefore&)
                    HWY_ATTR { lanes.slope.part[p] = hn::Max(lanes.slope.part[p], slope); });
}

HWY_INLINE void PathWalk::find_stretches(const SlicePacket& packet, uint32_t azimuth, int segment,
                                         Lanes& lanes, PacketView& view) {
  cross_segment(
      packet, segment, lanes,
      [&](size_t p, V slope, const glm::ivec2& corner, const Crossing& crossing, const FacetBefore& facet)
          HWY_ATTR {
            if (hn::AllTrue(kF, hn::Le(slope, lanes.slope.part[p]))) return;
            const V above = cosine_above(slope, lanes.rim.part[p]);
            // What rounding leaves nothing of is left to the next stretch.
            const auto seen = hn::And(hn::Gt(slope, lanes.slope.part[p]), hn::Lt(above, lanes.above.part[p]));
            alignas(64) float low[kWidth], high[kWidth], weight[kWidth];
            hn::Store(lanes.slope.part[p], kF, low);
            hn::Store(slope, kF, high);
            hn::Store(hn::Sub(lanes.above.part[p], above), kF, weight);
            lanes.slope.part[p] = hn::IfThenElse(seen, slope, lanes.slope.part[p]);
            lanes.above.part[p] = hn::IfThenElse(seen, above, lanes.above.part[p]);
            for_each_lane(seen, [&](size_t l) {
              const size_t lane = p * kWidth + l;
              view.stretches[lane].push_back({facet_at(corner, facet, static_cast<int>(lane)), weight[l],
                                              low[l], high[l], crossing.inverse_distance, azimuth});
            });
          });
}

// Follows the path again, up to what the samples of the slice below the horizon meet.
HWY_INLINE void PathWalk::find_hits(const SlicePacket& packet, uint32_t azimuth, Lanes& lanes,
                                    PacketView& view) {
  const Vectors shift = load(packet.place), per_weight = load(packet.hits_per_weight);
  const uint32_t linked = azimuth / static_cast<uint32_t>(options_.azimuths_per_linked);
  const float turn = static_cast<float>(radical_inverse(2, linked));
  hits_.most = 0;
  for (size_t p = 0; p < kParts; ++p) {
    const V sum = hn::Add(shift.part[p], hn::Set(kF, turn));
    place_hits(p, lanes.rim.part[p], lanes.slope.part[p], per_weight.part[p], hn::Sub(sum, hn::Floor(sum)),
               hits_);
  }
  if (hits_.most == 0) return;
  next_hit_ = {};
  for (size_t p = 0; p < kParts; ++p) lanes.slope.part[p] = hn::LoadU(kF, hits_.slope[0] + p * kWidth);
  for (int segment = 0;;) {
    if (!reaches_map(packet, segment) || segment > last_segment_) return;
    if (segment > 0) {
      if (nothing_left(lanes, segment)) return;
      const int skipped = segments_to_skip(packet, lanes, segment);
      segment += skipped;
      if (skipped > 0) continue;
    }
    meet_hits(packet, segment, lanes, view);
    ++segment;
  }
}

// Whether no lane can meet its next sample from `segment` on. A little below a slope of zero what a wrapping
// map meets may lie for ever away.
HWY_INLINE bool PathWalk::nothing_left(const Lanes& lanes, int segment) const {
  const V near = hn::Set(kF, inverse_distance(segment)), zero = hn::Zero(kF);
  bool all = true;
  for (size_t p = 0; p < kParts; ++p) {
    const V next = lanes.slope.part[p];
    const auto level = hn::And(hn::Ge(next, hn::Set(kF, -kLinkTolerance)), hn::Lt(next, zero));
    const V enough = hn::IfThenElse(level, hn::Set(kF, kHorizonTolerance), next);
    all = all && hn::AllTrue(kF, hn::Lt(hn::Mul(lanes.to_top.part[p], near), enough));
  }
  return all;
}

HWY_INLINE void PathWalk::meet_hits(const SlicePacket& packet, int segment, Lanes& lanes, PacketView& view) {
  const SlicePath& path = segments_.path();
  const V near = broadcast(segment * path.step), zero = hn::Zero(kF), one = hn::Set(kF, 1.0f);
  const glm::vec2 begin(segment_begin(path, segment)), direction(path.direction);
  const glm::ivec2 window = place(packet, segments_.corner(segment, 0));
  const float* heights = field_.heights.at(window.x, window.y);
  cross_segment(
      packet, segment, lanes,
      [&](size_t p, V slope, const glm::ivec2& corner, const Crossing& crossing,
          const FacetBefore& facet) HWY_ATTR {
        auto met = hn::Ge(slope, lanes.slope.part[p]);
        if (hn::AllFalse(kF, met)) return;
        const Crossing& entry = (&crossing)[-1];
        const V entered = hn::Set(kF, (&facet)[-1].along), left = hn::Set(kF, facet.along);
        // Heights over the start where the path enters the facet and where it leaves it.
        const V near_height = height_at(entry, heights, p, lanes), near_distance = hn::Add(near, entered);
        const V far_height = height_at(crossing, heights, p, lanes), far_distance = hn::Add(near, left);
        do {
          // How far a ray is above the facet where it enters, and below it where it leaves.
          const V next = lanes.slope.part[p];
          const V above = hn::Max(zero, hn::MulSub(next, near_distance, near_height));
          const V below = hn::Max(hn::Set(kF, 1e-30f), hn::NegMulAdd(next, far_distance, far_height));
          const V along = hn::MulAdd(hn::Div(above, hn::Add(above, below)), hn::Sub(left, entered), entered);
          const V distance = hn::Mul(hn::Add(near, along), hn::Sqrt(hn::MulAdd(next, next, one)));
          alignas(64) float slopes[kWidth], alongs[kWidth], distances[kWidth];
          hn::Store(next, kF, slopes);
          hn::Store(along, kF, alongs);
          hn::Store(distance, kF, distances);
          for_each_lane(met, [&](size_t l) {
            const size_t lane = p * kWidth + l;
            const size_t next_hit = ++next_hit_[lane];
            const glm::vec2 in_cell = begin + alongs[l] * direction - glm::vec2(facet.column, facet.row);
            const glm::vec2 uv = !facet.half ? in_cell : 1.0f - in_cell;
            view.hits[lane].push_back(
                {facet_at(corner, facet, static_cast<int>(lane)), 1, uv.x, uv.y, distances[l]});
            slopes[l] = hits_.slope[next_hit][lane];
          });
          lanes.slope.part[p] = hn::Load(kF, slopes);
          met = hn::Ge(slope, lanes.slope.part[p]);
        } while (!hn::AllFalse(kF, met));
      });
}

HWY_INLINE uint32_t PathWalk::facet_at(glm::ivec2 corner, const FacetBefore& facet, int lane) const {
  int column = corner.x + facet.column + lane, row = corner.y + facet.row, columns = field_.width;
  if (field_.wrap) {
    column = wrap_near(column, field_.width);
    row = wrap_near(row, field_.height);
  } else {
    // A path along the border runs beside the last cells.
    columns = field_.width - 1;
    column = std::clamp(column, 0, columns - 1);
    row = std::clamp(row, 0, field_.height - 2);
  }
  const uint32_t cell =
      static_cast<uint32_t>(row) * static_cast<uint32_t>(columns) + static_cast<uint32_t>(column);
  return 2 * cell + (facet.half ? 1 : 0);
}

// What a packet would see along all azimuths of its turn with nothing in the way.
void add_hemisphere(const SlicePaths& paths, const SlicePacket& packet, SliceSums& hemisphere) {
  for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
    const glm::dvec2& direction = paths.paths[paths.path_index(packet.turn, azimuth)].direction;
    add_sky(along(packet.rim_x, packet.rim_y, direction.x, direction.y), direction, hemisphere);
  }
}

template <Query kWhat>
void walk_all(const HeightPyramid& field, const SlicePaths& paths, const WalkOptions& options,
              std::span<const SlicePacket> packets, std::span<PacketView> views) {
  // Path after path, so that a path's crossings and the heights it meets stay in the caches.
  std::vector<size_t> order(packets.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return packets[a].turn < packets[b].turn; });
  for (size_t i = 0; i < packets.size(); ++i) add_hemisphere(paths, packets[i], views[i].hemisphere);
  PathWalk walk(field, paths, options);
  for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
    int turn = -1;
    for (const size_t index : order) {
      if (packets[index].turn != turn) {
        turn = packets[index].turn;
        walk.begin_path(paths.path_index(turn, azimuth));
      }
      if (kWhat == Query::kSampledHits && azimuth % options.azimuths_per_linked != 0) {
        walk.walk<Query::kHorizon>(packets[index], static_cast<uint32_t>(azimuth), views[index]);
      } else {
        walk.walk<kWhat>(packets[index], static_cast<uint32_t>(azimuth), views[index]);
      }
    }
  }
}

void walk_packets(const HeightPyramid& field, const SlicePaths& paths, const WalkOptions& options,
                  std::span<const SlicePacket> packets, std::span<PacketView> views) {
  switch (options.what) {
    case Query::kHorizon:
      return walk_all<Query::kHorizon>(field, paths, options, packets, views);
    case Query::kSampledHits:
      return walk_all<Query::kSampledHits>(field, paths, options, packets, views);
    case Query::kAllIntervals:
      return walk_all<Query::kAllIntervals>(field, paths, options, packets, views);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hemibake {

HWY_EXPORT(walk_packets);

void walk_packets(const HeightPyramid& field, const SlicePaths& paths, const WalkOptions& options,
                  std::span<const SlicePacket> packets, std::span<PacketView> views) {
  HWY_DYNAMIC_DISPATCH(walk_packets)(field, paths, options, packets, views);
}

}  // namespace hemibake
#endif  // HWY_ONCE
