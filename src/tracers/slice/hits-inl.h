// Computes with vectors over the lanes of a packet: the closed forms of a slice, and the slopes of its hits.
// Compiled once for every target of Highway: no include guard of the usual kind.
#if defined(HEMIBAKE_SLICE_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEMIBAKE_SLICE_HITS_INL_H
#undef HEMIBAKE_SLICE_HITS_INL_H
#else
#define HEMIBAKE_SLICE_HITS_INL_H
#endif

#include <hwy/highway.h>

#include "tracers/slice/fused-inl.h"
#include "tracers/slice/traversal.h"

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr size_t kParts = kSliceLanes / kWidth;

// One number per lane of a packet.
struct Vectors {
  V part[kParts];
};

// Starts of the lanes of a packet, and their horizons so far.
struct Lanes {
  Vectors base, rise;     // the start is `rise` above `base`
  Vectors to_top;         // from the start to the highest texel
  Vectors tangent_slope;  // lowest slope, where there is one receiver
  Vectors slope;          // of the horizon so far; while hits are found, of the next one
  Vectors above;          // kAllIntervals only: cosine_above the horizon so far
};

HWY_INLINE V broadcast(double value) { return hn::Set(kF, static_cast<float>(value)); }

HWY_INLINE Vectors load(const LaneArray<float>& values) {
  Vectors v;
  for (size_t p = 0; p < kParts; ++p) v.part[p] = hn::LoadU(kF, values.data() + p * kWidth);
  return v;
}

// Returns a · x + b · y.
HWY_INLINE Vectors along(const LaneArray<float>& a, const LaneArray<float>& b, double x, double y) {
  const Vectors va = load(a), vb = load(b);
  Vectors v;
  for (size_t p = 0; p < kParts; ++p)
    v.part[p] = mul_add(va.part[p], broadcast(x), hn::Mul(vb.part[p], broadcast(y)));
  return v;
}

// Calls act(lane of the part) for every lane of the mask.
template <class Act>
HWY_INLINE void for_each_lane(hn::Mask<F> mask, const Act& act) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(kF, mask, bytes);
  for (uint32_t bits = bytes[0] | static_cast<uint32_t>(bytes[1]) << 8; bits != 0; bits &= bits - 1)
    act(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
}

// ∫ of cos²θ and of sinθ cosθ over the elevations θ from a slope to the zenith.
struct SkyDirection {
  V horizontal, vertical;
};

HWY_INLINE SkyDirection direction_above(V m) {
  const V half = hn::Set(kF, 0.5f), quarter_turn = hn::Set(kF, 0.785398163f);
  const V cos2 = hn::Div(hn::Set(kF, 1.0f), mul_add(m, m, hn::Set(kF, 1.0f)));
  return {neg_mul_add(half, mul_add(m, cos2, hn::Atan(kF, m)), quarter_turn), hn::Mul(half, cos2)};
}

// Returns ∫ of cosθ from slope m to the zenith: 1 − sinθ, without cancellation near the zenith.
HWY_INLINE V uniform_above(V m) {
  const V one = hn::Set(kF, 1.0f), cos2 = hn::Div(one, mul_add(m, m, one));
  const V sine = hn::Mul(hn::Abs(m), hn::Sqrt(cos2));
  return hn::IfThenElse(hn::Lt(m, hn::Zero(kF)), hn::Add(one, sine), hn::Div(cos2, hn::Add(one, sine)));
}

// Returns ∫ of the cosine to the normal from slope m to the zenith, over normal.z.
// tangent_slope: of the plane normal to that normal, in this slice.
HWY_INLINE V cosine_above(V m, V tangent_slope) {
  const SkyDirection sky = direction_above(m);
  return neg_mul_add(tangent_slope, sky.horizontal, sky.vertical);
}

HWY_INLINE void add_lanes(V v, double* sum) {
  alignas(64) float values[kWidth];
  hn::Store(v, kF, values);
  for (size_t i = 0; i < kWidth; ++i) sum[i] += static_cast<double>(values[i]);
}

HWY_INLINE void add_sky(const Vectors& slope, const glm::dvec2& direction, SliceSums& sums) {
  for (size_t p = 0; p < kParts; ++p) {
    const size_t lane = p * kWidth;
    const SkyDirection sky = direction_above(slope.part[p]);
    add_lanes(uniform_above(slope.part[p]), sums.uniform.data() + lane);
    add_lanes(hn::Mul(sky.horizontal, broadcast(direction.x)), sums.x.data() + lane);
    add_lanes(hn::Mul(sky.horizontal, broadcast(direction.y)), sums.y.data() + lane);
    add_lanes(sky.vertical, sums.z.data() + lane);
  }
}

// Slope above every other: of lanes that are not traced, and after a lane's last hit.
constexpr float kUnreachable = 1e30f;

// A slice of a steep receiver holds up to π times the mean of its slices.
constexpr int kMostHits = 22 * kHitsPerSlice / 7 + 1;

// Slopes of a packet's hits, of all its receivers: the blocked part of each slice, sampled at equal steps of
// its weight.
struct HitSlopes {
  // Ascending; kUnreachable after a lane's last one.
  alignas(64) float slope[kMostReceivers * kMostHits + 1][kSliceLanes];
  alignas(64) float receiver[kMostReceivers * kMostHits + 1][kSliceLanes];  // whose hit it is
  int rows[kParts] = {};

  // Puts the rows of a part from `first` on, ascending like those before, in their places among these.
  HWY_INLINE void merge(size_t part, int first) {
    if (first == 0) return;
    for (int begin = first; begin < rows[part]; ++begin)
      for (int row = begin; row > 0; --row) {
        float *low = slope[row - 1] + part * kWidth, *high = slope[row] + part * kWidth;
        const V below = hn::Load(kF, low), above = hn::Load(kF, high);
        const auto swap = hn::Gt(below, above);
        if (hn::AllFalse(kF, swap)) break;
        hn::Store(hn::IfThenElse(swap, above, below), kF, low);
        hn::Store(hn::IfThenElse(swap, below, above), kF, high);
        float *whose_low = receiver[row - 1] + part * kWidth, *whose_high = receiver[row] + part * kWidth;
        const V low_one = hn::Load(kF, whose_low), high_one = hn::Load(kF, whose_high);
        hn::Store(hn::IfThenElse(swap, high_one, low_one), kF, whose_low);
        hn::Store(hn::IfThenElse(swap, low_one, high_one), kF, whose_high);
      }
  }
};

// A slice above the tangent plane, by the angle δ above it. With θ the angle of the plane, ∫ cosine over the
// slice up to δ, over normal.z, is (sin δ sin(δ + θ) − δ sin θ) / (2 cos θ), and grows by
// sin δ cos(δ + θ) / cos θ.
struct Slice {
  V angle, cosine, sine;  // of the tangent plane

  HWY_INLINE explicit Slice(V tangent_slope) {
    const V one = hn::Set(kF, 1.0f);
    angle = hn::Atan(kF, tangent_slope);
    cosine = hn::Div(one, hn::Sqrt(mul_add(tangent_slope, tangent_slope, one)));
    sine = hn::Mul(tangent_slope, cosine);
  }

  // Takes a step of Halley's method from δ towards the angle with `weight` below it, no further than `most`.
  HWY_INLINE V nearer(V delta, V weight, V most) const {
    const V s = hn::Sin(kF, delta), c = hn::Cos(kF, delta);
    const V sine_up = mul_add(s, cosine, hn::Mul(c, sine)), cosine_up = mul_sub(c, cosine, hn::Mul(s, sine));
    const V twice_below = mul_sub(s, sine_up, hn::Mul(delta, sine));
    const V error = neg_mul_add(hn::Add(weight, weight), cosine, twice_below);
    const V growth = hn::Mul(s, cosine_up), two = hn::Set(kF, 2.0f);
    const V bend = mul_sub(c, cosine_up, hn::Mul(s, sine_up));
    // f, f' and f'' of the equation, times 2 cos θ, cos θ and cos θ; the step is 2 f f' / (2 f'² − f f'').
    const V divisor = mul_sub(hn::Mul(two, growth), hn::Mul(two, growth), hn::Mul(error, bend));
    const V step = hn::Div(hn::Mul(hn::Mul(two, error), growth), hn::Max(divisor, hn::Set(kF, 1e-20f)));
    return hn::Min(most, hn::Max(hn::Zero(kF), hn::Sub(delta, step)));
  }

  HWY_INLINE V slope_at(V delta) const {
    const V s = hn::Sin(kF, delta), c = hn::Cos(kF, delta);
    return hn::Div(mul_add(s, cosine, hn::Mul(c, sine)),
                   hn::Max(mul_sub(c, cosine, hn::Mul(s, sine)), hn::Set(kF, 1e-20f)));
  }
};

// Places the hits of one part's lanes between the tangent plane and the horizon: at (offset + 0, 1, 2, …) /
// per_weight of the weight above the plane, so that all hits weigh alike. offset: in [0, 1).
// receiver: whose hits they are; the rows go behind those that are there.
HWY_INLINE void place_hits(size_t part, V tangent_slope, V horizon, V per_weight, V offset, float receiver,
                           HitSlopes& hits) {
  const V zero = hn::Zero(kF), one = hn::Set(kF, 1.0f), unreachable = hn::Set(kF, kUnreachable);
  const Slice slice(tangent_slope);
  const V most_delta = hn::Max(zero, hn::Sub(hn::Atan(kF, horizon), slice.angle));
  const V whole = hn::Max(cosine_above(tangent_slope, tangent_slope), hn::Set(kF, 1e-30f));
  const V blocked = hn::Sub(whole, cosine_above(horizon, tangent_slope));
  const V wanted = hn::Ceil(mul_sub(blocked, per_weight, offset));
  const V count = hn::IfThenElse(hn::Lt(horizon, unreachable),
                                 hn::Min(hn::Max(wanted, zero), hn::Set(kF, float{kMostHits})), zero);
  const V weight_of_hit = hn::Div(one, hn::Max(per_weight, hn::Set(kF, 1e-30f)));
  const int most = static_cast<int>(hn::GetLane(hn::MaxOfLanes(kF, count)));
  // The weight grows with the angle nearly as sin² does over a quarter rotation, exactly so on level ground.
  const V over_whole = hn::Div(one, whole);
  const V widths = hn::Sub(one, hn::Mul(slice.angle, hn::Set(kF, 0.636619772f)));
  V weight = hn::Mul(offset, weight_of_hit);
  for (int k = 0; k < most; ++k) {
    const V share = hn::Min(one, hn::Mul(weight, over_whole));
    const V delta = slice.nearer(hn::Mul(widths, hn::Asin(kF, hn::Sqrt(share))), weight, most_delta);
    const auto used = hn::Lt(hn::Set(kF, static_cast<float>(k)), count);
    const V slope = hn::Min(horizon, slice.slope_at(delta));
    const int row = hits.rows[part]++;
    hn::Store(hn::IfThenElse(used, slope, unreachable), kF, hits.slope[row] + part * kWidth);
    hn::Store(hn::Set(kF, receiver), kF, hits.receiver[row] + part * kWidth);
    weight = hn::Add(weight, weight_of_hit);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#endif  // HEMIBAKE_SLICE_HITS_INL_H
