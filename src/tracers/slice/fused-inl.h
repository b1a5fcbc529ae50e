// Products with sums rounded once, and functions made of them: the same numbers with every instruction set.
// Compiled once for every target of Highway: no include guard of the usual kind.
#if defined(HEMIBAKE_SLICE_FUSED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef HEMIBAKE_SLICE_FUSED_INL_H
#undef HEMIBAKE_SLICE_FUSED_INL_H
#else
#define HEMIBAKE_SLICE_FUSED_INL_H
#endif

#include <hwy/highway.h>

#include <bit>

#include "tracers/slice/traversal.h"

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, kSliceLanes>;
using V = hn::Vec<F>;
constexpr F kF;
constexpr size_t kWidth = hn::MaxLanes(F());

#define HEMIBAKE_ROUNDS_TWICE \
  (HWY_TARGET == HWY_SSSE3 || HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128)
#if HEMIBAKE_ROUNDS_TWICE

// Returns a b + c, rounded once as by an instruction. The sum in double is rounded to odd (Boldo and
// Melquiond 2008), so that rounding it again to float is right.
inline float fused_lane(float a, float b, float c) {
  const double product = static_cast<double>(a) * static_cast<double>(b), addend = static_cast<double>(c);
  const double sum = product + addend, part = sum - product;
  const double error = (product - (sum - part)) + (addend - part);
  auto bits = std::bit_cast<uint64_t>(sum);
  if ((error > 0 || error < 0) && bits % 2 == 0) bits += (error > 0) == (sum > 0) ? 1 : -1;
  return static_cast<float>(std::bit_cast<double>(bits));
}

// Returns a b + c.
HWY_INLINE V mul_add(V a, V b, V c) {
  alignas(64) float lanes[3][kWidth];
  hn::Store(a, kF, lanes[0]);
  hn::Store(b, kF, lanes[1]);
  hn::Store(c, kF, lanes[2]);
  for (size_t l = 0; l < kWidth; ++l) lanes[0][l] = fused_lane(lanes[0][l], lanes[1][l], lanes[2][l]);
  return hn::Load(kF, lanes[0]);
}
#else
HWY_INLINE V mul_add(V a, V b, V c) { return hn::MulAdd(a, b, c); }
#endif

// Returns a b − c.
HWY_INLINE V mul_sub(V a, V b, V c) { return mul_add(a, b, hn::Neg(c)); }

// Returns c − a b.
HWY_INLINE V neg_mul_add(V a, V b, V c) { return mul_add(hn::Neg(a), b, c); }

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

// hn::Atan, Asin, Sin and Cos multiply and add by these names, and find ours where the machine rounds twice.
#if HEMIBAKE_ROUNDS_TWICE
#define MulAdd hemibake::HWY_NAMESPACE::mul_add
#define MulSub hemibake::HWY_NAMESPACE::mul_sub
#define NegMulAdd hemibake::HWY_NAMESPACE::neg_mul_add
#endif
#include <hwy/contrib/math/math-inl.h>
#undef MulAdd
#undef MulSub
#undef NegMulAdd
#undef HEMIBAKE_ROUNDS_TWICE

#endif
