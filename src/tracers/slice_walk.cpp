#include "tracers/slice_walk.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracers/slice_walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// Must come after highway.h.
#include <hwy/contrib/math/math-inl.h>

#ifndef HEMIBAKE_SLICE_WALK_ONCE
#define HEMIBAKE_SLICE_WALK_ONCE
namespace hemibake {

// Slopes: an azimuth ends where no more than this can be gained.
constexpr float kHorizonTolerance = 1e-5f;
// Longer sides of the map after which a walk ends in any case.
constexpr double kFarthestMaps = 1e4;
// The slope of lanes that are not walked: above every other.
constexpr float kClosed = 1e30f;

}  // namespace hemibake
#endif

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kSliceLanes>;
using V = hn::Vec<F>;
constexpr F kF;
constexpr size_t kWidth = hn::MaxLanes(F());
constexpr size_t kParts = kSliceLanes / kWidth;

struct Vectors {
  V part[kParts];
};

Vectors load(const float* values) {
  Vectors v;
  for (size_t p = 0; p < kParts; ++p) v.part[p] = hn::LoadU(kF, values + p * kWidth);
  return v;
}

// ∫ over elevations from slope m to the zenith of cosθ, cos²θ and sinθ cosθ.
struct SkyAbove {
  V uniform, horizontal, vertical;
};

HWY_INLINE SkyAbove sky_above(V m) {
  const V one = hn::Set(kF, 1.0f), half = hn::Set(kF, 0.5f);
  const V cos2 = hn::Div(one, hn::MulAdd(m, m, one));
  const V cosine = hn::Sqrt(cos2);
  const V sine = hn::Mul(hn::Abs(m), cosine);
  // 1 − sinθ without cancellation where θ is near the zenith.
  const V above = hn::Div(cos2, hn::Add(one, sine));
  const V uniform = hn::IfThenElse(hn::Lt(m, hn::Zero(kF)), hn::Add(one, sine), above);
  const V quarter_turn = hn::Set(kF, 0.785398163f);
  const V horizontal =
      hn::NegMulAdd(half, hn::MulAdd(m, cos2, hn::Atan(kF, m)), quarter_turn);
  return {uniform, horizontal, hn::Mul(half, cos2)};
}

HWY_INLINE void add_lanes(V v, double* sum) {
  alignas(64) float values[kWidth];
  hn::Store(v, kF, values);
  for (size_t i = 0; i < kWidth; ++i) sum[i] += static_cast<double>(values[i]);
}

void add_sky(const Vectors& slope, const glm::dvec2& direction, SliceSums& sums) {
  const V dx = hn::Set(kF, static_cast<float>(direction.x)), dy = hn::Set(kF, static_cast<float>(direction.y));
  for (size_t p = 0; p < kParts; ++p) {
    const SkyAbove sky = sky_above(slope.part[p]);
    add_lanes(sky.uniform, sums.uniform.data() + p * kWidth);
    add_lanes(hn::Mul(sky.horizontal, dx), sums.x.data() + p * kWidth);
    add_lanes(hn::Mul(sky.horizontal, dy), sums.y.data() + p * kWidth);
    add_lanes(sky.vertical, sums.z.data() + p * kWidth);
  }
}

class PacketWalk {
 public:
  PacketWalk(const SliceField& field, const SlicePaths& paths, const SlicePacket& packet)
      : field_(field), paths_(paths), packet_(packet), base_(load(packet.base.data())) {
    last_segment_ = static_cast<int>(kFarthestMaps * std::max({field.width, field.height, kSegmentCells}) /
                                     kSegmentCells);
    for (size_t p = 0; p < kParts; ++p)
      walked_[p] = hn::FirstN(kF, static_cast<size_t>(std::max(0, packet.lanes - static_cast<int>(p * kWidth))));
  }

  // Raises `slope` to the horizon along a path.
  void find_horizon(int path_index, Vectors& slope, LaneArray<uint32_t>& cut_short);

  // Lowest slope of each lane's hemisphere along a direction.
  Vectors hemisphere_rim(const glm::dvec2& direction) const {
    const Vectors x = load(packet_.rim_x.data()), y = load(packet_.rim_y.data());
    const V dx = hn::Set(kF, static_cast<float>(direction.x)), dy = hn::Set(kF, static_cast<float>(direction.y));
    Vectors rim;
    for (size_t p = 0; p < kParts; ++p)
      rim.part[p] = hn::MulAdd(x.part[p], dx, hn::Mul(y.part[p], dy));
    return rim;
  }

 private:
  bool reaches_map(const glm::ivec2& corner) const {
    return field_.wrap || (corner.x < field_.width && corner.y < field_.height &&
                           corner.x + kSliceLanes + kSegmentCells >= 0 && corner.y + kSegmentCells + 1 >= 0);
  }
  glm::ivec2 corner_of(const SlicePath& path, int segment, int level) const;
  bool stays_below(const float* tallest, float inverse_near, float inverse_far, const Vectors& slope) const;
  const Segment& segment_of(int path_index, int segment);

  const SliceField& field_;
  const SlicePaths& paths_;
  const SlicePacket& packet_;
  Vectors base_;
  Vectors rise_;  // of the start above base
  hn::Mask<F> walked_[kParts];
  int last_segment_;
  Segment far_segment_;
};

glm::ivec2 PacketWalk::corner_of(const SlicePath& path, int segment, int level) const {
  const glm::ivec2 corner = glm::ivec2(packet_.x, packet_.y) + path.window(segment, kSkipSegments[level]);
  if (!field_.wrap) return corner;
  return {wrap_index(corner.x, field_.width), wrap_index(corner.y, field_.height)};
}

// Whether nothing of the heights `tallest` at distances between near and far rises above `slope`, in any lane.
HWY_INLINE bool PacketWalk::stays_below(const float* tallest, float inverse_near, float inverse_far,
                                        const Vectors& slope) const {
  const V near = hn::Set(kF, inverse_near), far = hn::Set(kF, inverse_far);
  bool below = true;
  for (size_t p = 0; p < kParts; ++p) {
    const V rise = hn::Sub(hn::Sub(hn::LoadU(kF, tallest + p * kWidth), base_.part[p]), rise_.part[p]);
    const V steepest = hn::Max(hn::Mul(rise, near), hn::Mul(rise, far));
    below = below && hn::AllTrue(kF, hn::Le(steepest, slope.part[p]));
  }
  return below;
}

const Segment& PacketWalk::segment_of(int path_index, int segment) {
  if (segment < paths_.ready_segments)
    return paths_.segments[static_cast<size_t>(path_index) * static_cast<size_t>(paths_.ready_segments) +
                           static_cast<size_t>(segment)];
  find_crossings(paths_.paths[static_cast<size_t>(path_index)], segment, paths_.starts_in_facet, field_.pitch,
                 far_segment_);
  return far_segment_;
}

void PacketWalk::find_horizon(int path_index, Vectors& slope, LaneArray<uint32_t>& cut_short) {
  const SlicePath& path = paths_.paths[static_cast<size_t>(path_index)];
  const Vectors plane_x = load(packet_.plane_x.data()), plane_y = load(packet_.plane_y.data());
  const V origin_x = hn::Set(kF, static_cast<float>(path.origin.x) - packet_.corner),
          origin_y = hn::Set(kF, static_cast<float>(path.origin.y) - packet_.corner);
  const V closed = hn::Set(kF, kClosed), top = hn::Set(kF, field_.top);
  Vectors to_top;
  for (size_t p = 0; p < kParts; ++p) {
    rise_.part[p] = hn::MulAdd(plane_x.part[p], origin_x, hn::Mul(plane_y.part[p], origin_y));
    to_top.part[p] = hn::Sub(hn::Sub(top, base_.part[p]), rise_.part[p]);
    slope.part[p] = hn::IfThenElse(walked_[p], slope.part[p], closed);
    // Where the map repeats for ever, whatever goes down meets it.
    if (field_.wrap) slope.part[p] = hn::Max(slope.part[p], hn::Zero(kF));
  }
  const V tolerance = hn::Set(kF, kHorizonTolerance);
  const float inverse_step = static_cast<float>(1 / path.step);
  for (int segment = 0;;) {
    const float inverse_near = inverse_step / static_cast<float>(segment);
    if (segment > 0) {
      const V near = hn::Set(kF, inverse_near);
      bool ended = segment > last_segment_;
      if (!ended) {
        ended = true;
        for (size_t p = 0; p < kParts; ++p)
          ended = ended && hn::AllTrue(kF, hn::Le(hn::Mul(to_top.part[p], near), hn::Add(slope.part[p], tolerance)));
      }
      if (ended) {
        for (size_t p = 0; p < kParts; ++p) {
          uint8_t bits[8] = {};
          hn::StoreMaskBits(kF, hn::Gt(hn::Mul(to_top.part[p], near), slope.part[p]), bits);
          for (size_t lane = 0; lane < kWidth; ++lane)
            cut_short[p * kWidth + lane] += (bits[lane / 8] >> (lane % 8)) & 1;
        }
        return;
      }
      bool skipped = false;
      for (int level = kSkipLevels - 1; level >= 0 && !skipped; --level) {
        const int segments = kSkipSegments[level];
        if (segment % segments != 0) continue;
        const glm::ivec2 corner = corner_of(path, segment, level);
        if (!reaches_map(level == 0 ? corner : corner_of(path, segment, 0))) return;
        const float inverse_far = inverse_step / static_cast<float>(segment + segments);
        skipped = stays_below(field_.tallest[static_cast<size_t>(level)].data() + field_.index(corner.x, corner.y),
                              inverse_near, inverse_far, slope);
        if (skipped) segment += segments;
      }
      if (skipped) continue;
    }
    const glm::ivec2 corner = corner_of(path, segment, 0);
    if (!reaches_map(corner)) return;
    const float* heights = field_.heights.data() + field_.index(corner.x, corner.y);
    for (const Crossing& crossing : segment_of(path_index, segment).crossings) {
      const V fraction = hn::Set(kF, crossing.fraction), inverse = hn::Set(kF, crossing.inverse_distance);
      for (size_t p = 0; p < kParts; ++p) {
        const V a = hn::LoadU(kF, heights + crossing.a + p * kWidth), b = hn::LoadU(kF, heights + crossing.b + p * kWidth);
        const V rise = hn::Add(hn::Sub(a, base_.part[p]), hn::MulSub(fraction, hn::Sub(b, a), rise_.part[p]));
        slope.part[p] = hn::Max(slope.part[p], hn::Mul(rise, inverse));
      }
    }
    ++segment;
  }
}

void walk_horizons(const SliceField& field, const SlicePaths& paths, int turn, const SlicePacket& packet,
                   PacketView& view) {
  PacketWalk walk(field, paths, packet);
  for (int azimuth = 0; azimuth < paths.azimuths; ++azimuth) {
    const int path_index = turn * paths.azimuths + azimuth;
    const glm::dvec2& direction = paths.paths[static_cast<size_t>(path_index)].direction;
    Vectors slope = walk.hemisphere_rim(direction);
    add_sky(slope, direction, view.hemisphere);
    walk.find_horizon(path_index, slope, view.cut_short);
    add_sky(slope, direction, view.sky);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hemibake {

HWY_EXPORT(walk_horizons);

PacketView walk_horizons(const SliceField& field, const SlicePaths& paths, int turn, const SlicePacket& packet) {
  PacketView view;
  HWY_DYNAMIC_DISPATCH(walk_horizons)(field, paths, turn, packet, view);
  return view;
}

}  // namespace hemibake
#endif  // HWY_ONCE
