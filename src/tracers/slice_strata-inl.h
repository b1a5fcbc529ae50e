// Vectors over the lanes of a packet, the closed forms of a slice, and the slopes at which a slice is sampled
// for links. Compiled once for every target of Highway: no include guard of the usual kind.
#if defined(HEMIBAKE_SLICE_STRATA_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEMIBAKE_SLICE_STRATA_INL_H
#undef HEMIBAKE_SLICE_STRATA_INL_H
#else
#define HEMIBAKE_SLICE_STRATA_INL_H
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "tracers/slice_walk.h"

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kSliceLanes>;
using V = hn::Vec<F>;
constexpr F kF;
constexpr size_t kWidth = hn::MaxLanes(F());
constexpr size_t kParts = kSliceLanes / kWidth;

// One number per lane of a packet.
struct Vectors {
  V part[kParts];
};

HWY_INLINE V broadcast(double value) { return hn::Set(kF, static_cast<float>(value)); }

HWY_INLINE Vectors load(const LaneArray<float>& values) {
  Vectors v;
  for (size_t p = 0; p < kParts; ++p) v.part[p] = hn::LoadU(kF, values.data() + p * kWidth);
  return v;
}

// a · x + b · y
HWY_INLINE Vectors along(const LaneArray<float>& a, const LaneArray<float>& b, double x, double y) {
  const Vectors va = load(a), vb = load(b);
  Vectors v;
  for (size_t p = 0; p < kParts; ++p)
    v.part[p] = hn::MulAdd(va.part[p], broadcast(x), hn::Mul(vb.part[p], broadcast(y)));
  return v;
}

// ∫ over the elevations θ from slope m to the zenith of cos²θ and of sinθ cosθ.
struct SkyDirection {
  V horizontal, vertical;
};

HWY_INLINE SkyDirection direction_above(V m) {
  const V half = hn::Set(kF, 0.5f), quarter_turn = hn::Set(kF, 0.785398163f);
  const V cos2 = hn::Div(hn::Set(kF, 1.0f), hn::MulAdd(m, m, hn::Set(kF, 1.0f)));
  return {hn::NegMulAdd(half, hn::MulAdd(m, cos2, hn::Atan(kF, m)), quarter_turn), hn::Mul(half, cos2)};
}

// The same of cosθ: 1 − sinθ, without cancellation near the zenith.
HWY_INLINE V uniform_above(V m) {
  const V one = hn::Set(kF, 1.0f), cos2 = hn::Div(one, hn::MulAdd(m, m, one));
  const V sine = hn::Mul(hn::Abs(m), hn::Sqrt(cos2));
  return hn::IfThenElse(hn::Lt(m, hn::Zero(kF)), hn::Add(one, sine), hn::Div(cos2, hn::Add(one, sine)));
}

// The same of the cosine to a normal whose plane has the slope `rim` in this slice, over normal.z.
HWY_INLINE V cosine_above(V m, V rim) {
  const SkyDirection sky = direction_above(m);
  return hn::NegMulAdd(rim, sky.horizontal, sky.vertical);
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

// The slope of lanes that are not walked: above every other.
constexpr float kClosed = 1e30f;

// A slice of a steep receiver holds up to π times the mean of its slices.
constexpr int kMostStrata = 22 * kStrataPerSlice / 7 + 1;

// Where a packet's slices are sampled: the blocked part of each lane's slice is cut into strata of equal
// angle, as many as its share of the hemisphere is worth, with one sample in each.
struct Strata {
  // Slopes, ascending; kClosed after a lane's last one.
  alignas(64) float slope[kMostStrata + 1][kSliceLanes];
  alignas(64) float weight[kMostStrata][kSliceLanes];  // ∫ cosine over the stratum, over normal.z
  int most = 0;                                        // strata of the lane with the most
};

// ∫ cosine from the angle with this cosine and sine to the zenith, over normal.z.
HWY_INLINE V cosine_above_angle(V angle, V cosine, V sine, V rim) {
  const V half = hn::Set(kF, 0.5f), quarter_turn = hn::Set(kF, 0.785398163f);
  const V horizontal = hn::NegMulAdd(half, hn::MulAdd(sine, cosine, angle), quarter_turn);
  return hn::NegMulAdd(rim, horizontal, hn::Mul(half, hn::Mul(cosine, cosine)));
}

// Strata of the lanes of one part, from the slope `rim` to `horizon`. `per_weight`: strata per unit of
// weight; `place`: of the sample in its stratum, as a share of the weight, 0..1.
HWY_INLINE void add_strata(size_t part, V rim, V horizon, V per_weight, V place, Strata& strata) {
  const V zero = hn::Zero(kF), one = hn::Set(kF, 1.0f);
  V cosine = hn::Div(one, hn::Sqrt(hn::MulAdd(rim, rim, one))), sine = hn::Mul(rim, cosine);
  const V low = hn::Atan(kF, rim), range = hn::Max(zero, hn::Sub(hn::Atan(kF, horizon), low));
  V above = cosine_above(rim, rim);
  const V blocked = hn::Sub(above, cosine_above(horizon, rim));
  const V wanted = hn::Min(hn::Ceil(hn::Mul(blocked, per_weight)), hn::Set(kF, float{kMostStrata}));
  const V count = hn::IfThenElse(hn::Lt(horizon, hn::Set(kF, kClosed)), hn::Max(wanted, zero), zero);
  const V step = hn::Div(range, hn::Max(count, one));
  const V step_cosine = hn::Cos(kF, step), step_sine = hn::Sin(kF, step);
  const auto density = [&](V c, V s) { return hn::Max(zero, hn::Mul(c, hn::NegMulAdd(rim, c, s))); };
  V density_low = zero;
  const int most = static_cast<int>(hn::GetLane(hn::MaxOfLanes(kF, count)));
  strata.most = std::max(strata.most, most);
  for (int k = 0; k < most; ++k) {
    const V number = hn::Set(kF, static_cast<float>(k));
    const auto used = hn::Lt(number, count);
    const V next_cosine = hn::Max(zero, hn::MulSub(cosine, step_cosine, hn::Mul(sine, step_sine)));
    const V next_sine = hn::MulAdd(sine, step_cosine, hn::Mul(cosine, step_sine));
    const V angle = hn::MulAdd(hn::Add(number, one), step, low);
    const V next_above = cosine_above_angle(angle, next_cosine, next_sine, rim);
    // The density of weight runs nearly straight through a stratum; the sample has the share `place` of the
    // weight below it.
    const V density_high = density(next_cosine, next_sine);
    const V squared = hn::Mul(density_low, density_low);
    const V root = hn::Sqrt(hn::MulAdd(place, hn::MulSub(density_high, density_high, squared), squared));
    const V share = hn::Div(hn::Mul(place, hn::Add(density_low, density_high)),
                            hn::Max(hn::Add(density_low, root), hn::Set(kF, 1e-30f)));
    const V sample_sine = hn::MulAdd(share, hn::Sub(next_sine, sine), sine);
    const V sample_cosine = hn::MulAdd(share, hn::Sub(next_cosine, cosine), cosine);
    const V slope = hn::Min(horizon, hn::Div(sample_sine, hn::Max(sample_cosine, hn::Set(kF, 1e-20f))));
    hn::StoreU(hn::IfThenElse(used, slope, hn::Set(kF, kClosed)), kF, strata.slope[k] + part * kWidth);
    hn::StoreU(hn::IfThenElse(used, hn::Max(zero, hn::Sub(above, next_above)), zero), kF,
               strata.weight[k] + part * kWidth);
    cosine = next_cosine;
    sine = next_sine;
    above = next_above;
    density_low = density_high;
  }
  hn::StoreU(hn::Set(kF, kClosed), kF, strata.slope[most] + part * kWidth);
}

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#endif  // HEMIBAKE_SLICE_STRATA_INL_H
