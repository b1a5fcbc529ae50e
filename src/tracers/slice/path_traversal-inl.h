// Follows one path for packet after packet: horizons, and the segments that cannot raise them. Compiled once
// for every target of Highway: no include guard of the usual kind.
#if defined(HEMIBAKE_SLICE_PATH_TRAVERSAL_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEMIBAKE_SLICE_PATH_TRAVERSAL_INL_H
#undef HEMIBAKE_SLICE_PATH_TRAVERSAL_INL_H
#else
#define HEMIBAKE_SLICE_PATH_TRAVERSAL_INL_H
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "tracers/slice/hits-inl.h"
#include "tracers/slice/segments.h"
#include "tracers/slice/traversal.h"

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {

// Slope: an azimuth ends where its horizon can rise by no more than this.
constexpr float kHorizonTolerance = 1e-4f;
// Slope below zero up to which hits are looked for where everything below zero is blocked.
constexpr float kHitTolerance = 1e-3f;
// Longer sides of the map after which a path ends in any case.
constexpr double kFarthestMaps = 1e4;
// Segment from which on heights are seldom in the nearest cache.
constexpr int kColdSegments = 16;

// Follows one path at a time, for packet after packet.
class PathTraversal {
 public:
  PathTraversal(const HeightPyramid& pyramid, const SlicePaths& paths, const TraversalOptions& options)
      : pyramid_(pyramid), options_(options), segments_(pyramid, paths) {
    const double farthest = kFarthestMaps * std::max({pyramid.width, pyramid.height, kSegmentCells});
    last_segment_ = static_cast<int>(std::min(farthest, options.max_distance) / kSegmentCells);
    blocks_below_ = pyramid.ends_at_horizontal && std::isinf(options.max_distance);
  }

  void begin_path(size_t index) {
    segments_.begin_path(index);
    inverse_step_ = static_cast<float>(1 / segments_.path().step);
  }

  // Adds to `views` what the receivers of a packet see along the path.
  template <Query kQuery>
  void trace(const SlicePacket& packet, std::span<const SliceReceivers> receivers, uint32_t azimuth,
             std::span<PacketView> views) {
    const SlicePath& path = segments_.path();
    Lanes lanes = start(packet, receivers);
    for (int segment = 0;;) {
      if (!reaches_map(packet, segment)) break;
      if (segment > last_segment_) {
        if (blocks_below_) count_truncated(lanes, segment, views);
        break;
      }
      if (segment > 0) {
        if (horizon_is_final(lanes, segment)) break;
        const int skipped = segments_to_skip(packet, lanes, segment);
        segment += skipped;
        if (skipped > 0) continue;
      }
      if constexpr (kQuery == Query::kAllIntervals) {
        find_intervals(packet, azimuth, segment, lanes, views.front());
      } else {
        raise_horizon(packet, segment, lanes);
      }
      ++segment;
    }
    if (blocks_below_)
      for (V& slope : lanes.slope.part) slope = hn::Max(slope, hn::Zero(kF));
    const Vectors horizon = lanes.slope;
    for (size_t r = 0; r < receivers.size(); ++r)
      add_sky(above_tangent(receivers[r], horizon), path.direction, views[r].sky);
    if constexpr (kQuery == Query::kSampledHits) find_hits(packet, receivers, azimuth, lanes, views);
  }

 private:
  Vectors tangent_slope(const SliceReceivers& receivers) const;
  Vectors above_tangent(const SliceReceivers& receivers, const Vectors& horizon) const;
  Lanes start(const SlicePacket& packet, std::span<const SliceReceivers> receivers) const;
  bool horizon_is_final(const Lanes& lanes, int segment) const;
  void count_truncated(const Lanes& lanes, int segment, std::span<PacketView> views) const;
  int segments_to_skip(const SlicePacket& packet, const Lanes& lanes, int segment);
  void raise_horizon(const SlicePacket& packet, int segment, Lanes& lanes);
  void find_intervals(const SlicePacket& packet, uint32_t azimuth, int segment, Lanes& lanes,
                      PacketView& view);
  bool place_all_hits(std::span<const SliceReceivers> receivers, uint32_t azimuth, const Vectors& horizon);
  void find_hits(const SlicePacket& packet, std::span<const SliceReceivers> receivers, uint32_t azimuth,
                 Lanes& lanes, std::span<PacketView> views);
  bool hits_are_final(const Lanes& lanes, int segment) const;
  void find_segment_hits(const SlicePacket& packet, int segment, Lanes& lanes, std::span<PacketView> views);
  void fetch_window(const float* heights) const;
  template <class Visit>
  void for_each_crossing(const SlicePacket& packet, int segment, const Lanes& lanes, const Visit& visit);
  uint32_t facet_at(glm::ivec2 corner, const FacetBefore& facet, int lane) const;

  // Returns 1 / the horizontal distance at which a segment begins.
  float inverse_distance(int segment) const { return inverse_step_ / static_cast<float>(segment); }
  // Returns the first corner in the map of a window that begins at `corner` from the start's cell.
  glm::ivec2 window_in_map(const SlicePacket& packet, glm::ivec2 corner) const {
    int x = packet.x + corner.x, y = packet.y + corner.y;
    if (pyramid_.wrap && x >= pyramid_.width) x -= pyramid_.width;
    if (pyramid_.wrap && y >= pyramid_.height) y -= pyramid_.height;
    return {x, y};
  }
  bool reaches_map(const SlicePacket& packet, int segment) const {
    if (pyramid_.wrap) return true;
    const glm::ivec2 corner = window_in_map(packet, segments_.corner(segment, 0));
    return corner.x < pyramid_.width && corner.y < pyramid_.height &&
           corner.x + kSliceLanes + kSegmentCells >= 0 && corner.y + kSegmentCells + 1 >= 0;
  }

  const HeightPyramid& pyramid_;
  TraversalOptions options_;
  SegmentSource segments_;
  float inverse_step_ = 0;
  int last_segment_;
  bool blocks_below_;  // the map repeats for ever and meets whatever goes down
  HitSlopes hits_;     // of the current packet
  LaneArray<uint8_t> next_hit_;
};

HWY_INLINE hn::Mask<F> traced(const SliceReceivers& receivers, size_t part) {
  const uint32_t lanes = receivers.lanes >> part * kWidth;
  const uint8_t bits[8] = {static_cast<uint8_t>(lanes), static_cast<uint8_t>(lanes >> 8)};
  return hn::LoadMaskBits(kF, bits);
}

HWY_INLINE Vectors PathTraversal::tangent_slope(const SliceReceivers& receivers) const {
  const glm::dvec2& direction = segments_.path().direction;
  return along(receivers.tangent_slope_x, receivers.tangent_slope_y, direction.x, direction.y);
}

// Returns the horizon of receivers: nothing below their tangent planes is seen. kUnreachable: not traced.
HWY_INLINE Vectors PathTraversal::above_tangent(const SliceReceivers& receivers,
                                                const Vectors& horizon) const {
  Vectors slope = tangent_slope(receivers);
  for (size_t p = 0; p < kParts; ++p)
    slope.part[p] = hn::IfThenElse(traced(receivers, p), hn::Max(slope.part[p], horizon.part[p]),
                                   hn::Set(kF, kUnreachable));
  return slope;
}

// Begins at the lowest of the receivers' tangent planes.
HWY_INLINE Lanes PathTraversal::start(const SlicePacket& packet,
                                      std::span<const SliceReceivers> receivers) const {
  const SlicePath& path = segments_.path();
  const auto corner = static_cast<double>(packet.corner);
  Lanes lanes;
  lanes.base = load(packet.base);
  lanes.rise = along(packet.plane_x, packet.plane_y, path.origin.x - corner, path.origin.y - corner);
  lanes.tangent_slope = tangent_slope(receivers.front());
  const V top = hn::Set(kF, pyramid_.top), unreachable = hn::Set(kF, kUnreachable);
  for (size_t p = 0; p < kParts; ++p) {
    lanes.to_top.part[p] = hn::Sub(hn::Sub(top, lanes.base.part[p]), lanes.rise.part[p]);
    lanes.slope.part[p] =
        hn::IfThenElse(traced(receivers.front(), p), lanes.tangent_slope.part[p], unreachable);
  }
  for (const SliceReceivers& others : receivers.subspan(1)) {
    const Vectors tangent = tangent_slope(others);
    for (size_t p = 0; p < kParts; ++p)
      lanes.slope.part[p] =
          hn::Min(lanes.slope.part[p], hn::IfThenElse(traced(others, p), tangent.part[p], unreachable));
  }
  for (size_t p = 0; p < kParts; ++p) {
    V& slope = lanes.slope.part[p];
    if (blocks_below_ && options_.query != Query::kAllIntervals) slope = hn::Max(slope, hn::Zero(kF));
    if (options_.query == Query::kAllIntervals)
      lanes.above.part[p] = cosine_above(slope, lanes.tangent_slope.part[p]);
  }
  return lanes;
}

// Returns whether no lane's horizon can rise by more than the tolerance from `segment` on.
HWY_INLINE bool PathTraversal::horizon_is_final(const Lanes& lanes, int segment) const {
  const V near = hn::Set(kF, inverse_distance(segment)), low = hn::Set(kF, -kHitTolerance);
  bool all = true;
  for (size_t p = 0; p < kParts; ++p) {
    V slope = lanes.slope.part[p];
    if (blocks_below_) slope = hn::IfThenElse(hn::Ge(slope, low), hn::Max(slope, hn::Zero(kF)), slope);
    const V enough = hn::Add(slope, hn::Set(kF, kHorizonTolerance));
    all = all && hn::AllTrue(kF, hn::Le(hn::Mul(lanes.to_top.part[p], near), enough));
  }
  return all;
}

HWY_INLINE void PathTraversal::count_truncated(const Lanes& lanes, int segment,
                                               std::span<PacketView> views) const {
  const V near = hn::Set(kF, inverse_distance(segment));
  for (size_t p = 0; p < kParts; ++p) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(kF, hn::Gt(hn::Mul(lanes.to_top.part[p], near), lanes.slope.part[p]), bits);
    for (PacketView& view : views)
      for (size_t lane = 0; lane < kWidth; ++lane)
        view.truncated[p * kWidth + lane] += (bits[lane / 8] >> (lane % 8)) & 1;
  }
}

// Returns the number of segments from `segment` on that one max mip shows to be below every lane's horizon.
HWY_INLINE int PathTraversal::segments_to_skip(const SlicePacket& packet, const Lanes& lanes, int segment) {
  const V near = hn::Set(kF, inverse_distance(segment));
  for (int level = kMipLevels - 1; level >= 0; --level) {
    const int segments = kMipSegments[level];
    if (segment % segments != 0 || (level == 1 && segment < kFarSegments)) continue;
    const glm::ivec2 corner = window_in_map(packet, segments_.corner(segment, level));
    const HeightPlane& plane = pyramid_.max_mips[static_cast<size_t>(level)];
    const float* mip = plane.at(corner.x, corner.y);
    const V far = hn::Set(kF, inverse_distance(segment + segments));
    bool below = true;
    for (size_t p = 0; p < kParts; ++p) {
      const V tall = plane.column_shift > 0 ? hn::Set(kF, *mip) : hn::LoadU(kF, mip + p * kWidth);
      const V rise = hn::Sub(hn::Sub(tall, lanes.base.part[p]), lanes.rise.part[p]);
      const V steepest = hn::Max(hn::Mul(rise, near), hn::Mul(rise, far));
      below = below && hn::AllTrue(kF, hn::Le(steepest, lanes.slope.part[p]));
    }
    if (below) return segments;
  }
  return 0;
}

// Returns the height of a crossing over the starts. heights: at the first corner of the segment's window.
HWY_INLINE V height_at(const Crossing& crossing, const float* heights, size_t part, const Lanes& lanes) {
  const V a = hn::LoadU(kF, heights + crossing.a + part * kWidth);
  const V b = hn::LoadU(kF, heights + crossing.b + part * kWidth);
  const V along_edge = mul_sub(hn::Set(kF, crossing.fraction), hn::Sub(b, a), lanes.rise.part[part]);
  return hn::Add(hn::Sub(a, lanes.base.part[part]), along_edge);
}

// Prefetches the heights of a segment's window.
HWY_INLINE void PathTraversal::fetch_window(const float* heights) const {
  for (size_t row = 0; row < kSegmentCells + 2; ++row) {
    hwy::Prefetch(heights + row * pyramid_.heights.pitch);
    hwy::Prefetch(heights + row * pyramid_.heights.pitch + kSliceLanes);
  }
}

// Calls visit(part, slope, corner, crossing, facet before it) for every crossing of a segment but its first,
// by distance. Every crossing and facet has the one before it right before it in memory.
template <class Visit>
HWY_INLINE void PathTraversal::for_each_crossing(const SlicePacket& packet, int segment, const Lanes& lanes,
                                                 const Visit& visit) {
  const glm::ivec2 corner = window_in_map(packet, segments_.corner(segment, 0));
  const float* heights = pyramid_.heights.at(corner.x, corner.y);
  if (segment >= kColdSegments) fetch_window(heights);
  const SegmentView crossed = segments_.crossings(segment);
  for (size_t i = 1; i < crossed.crossings.size(); ++i) {
    const Crossing& crossing = crossed.crossings[i];
    const V inverse = hn::Set(kF, crossing.inverse_distance);
    for (size_t p = 0; p < kParts; ++p)
      visit(p, hn::Mul(height_at(crossing, heights, p, lanes), inverse), corner, crossing, crossed.facets[i]);
  }
}

HWY_INLINE void PathTraversal::raise_horizon(const SlicePacket& packet, int segment, Lanes& lanes) {
  for_each_crossing(packet, segment, lanes,
                    [&](size_t p, V slope, const glm::ivec2&, const Crossing&, const FacetBefore&)
                        HWY_ATTR { lanes.slope.part[p] = hn::Max(lanes.slope.part[p], slope); });
}

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#endif  // HEMIBAKE_SLICE_PATH_TRAVERSAL_INL_H
