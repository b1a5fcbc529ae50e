// The product of packed links and values, vector by vector: a group's weights are spread to the columns that
// they belong to and multiplied with the group's values as they lie in memory; nothing is fetched one by one.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "transport/links.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/links_gather.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef HEMIBAKE_LINKS_GATHER_ONCE
#define HEMIBAKE_LINKS_GATHER_ONCE
namespace hemibake {

constexpr size_t kLanes = LinkBlock::kColumnsPerGroup;

// For every set of columns, the bytes of 8 packed weights that go to each of the 8 columns; those of columns
// without a link are zero, for which TableLookupBytesOr0 wants the top bit.
using SpreadTable = std::array<std::array<uint8_t, 2 * kLanes>, 256>;

constexpr SpreadTable make_spread_table() {
  SpreadTable table{};
  for (uint32_t columns = 0; columns < 256; ++columns) {
    uint8_t from = 0;
    for (uint32_t column = 0; column < kLanes; ++column) {
      const bool linked = columns >> column & 1;
      table[columns][2 * column] = linked ? from++ : uint8_t{0x80};
      table[columns][2 * column + 1] = linked ? from++ : uint8_t{0x80};
    }
  }
  return table;
}

alignas(16) inline constexpr SpreadTable kSpread = make_spread_table();

}  // namespace hemibake
#endif

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

// A machine without vectors: the same, a column at a time.
void gather_block(const BlockView& block, const double* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const uint16_t* HWY_RESTRICT code = block.codes;
  const uint16_t* HWY_RESTRICT weight = block.weights;
  for (size_t row = 0; row < block.rows.size(); ++row) {
    double sum = 0;
    const double* at = values + size_t{first_group(block.rows[row], block.anchor)} * kLanes;
    for (; *code != 0; ++code) {
      at += groups_ahead(*code) * kLanes;
      for (uint32_t columns = *code >> 8; columns != 0; columns &= columns - 1)
        sum += *weight++ * at[std::countr_zero(columns)];
    }
    ++code;
    out[row] = sum * quantum_of(block.rows[row]);
  }
}

#else

using F = hn::CappedTag<double, kLanes>;
constexpr F kF;
constexpr size_t kWidth = hn::MaxLanes(F());
constexpr size_t kParts = kLanes / kWidth;
constexpr hn::FixedTag<uint16_t, kLanes> kWeights;
constexpr hn::FixedTag<uint8_t, 2 * kLanes> kBytes;
using Weights = hn::Vec<hn::FixedTag<uint16_t, kLanes> >;

// The first kCount lanes.
template <size_t kCount>
HWY_INLINE auto first_lanes(Weights weights) {
  if constexpr (kCount == kLanes) {
    return weights;
  } else {
    constexpr hn::FixedTag<uint16_t, 4> kHalf;
    const auto half = hn::LowerHalf(kHalf, weights);
    if constexpr (kCount == 4) return half;
    if constexpr (kCount == 2) return hn::LowerHalf(hn::Half<hn::FixedTag<uint16_t, 4> >(), half);
  }
}

// Weights of the lanes from kPart · kWidth on.
template <size_t kPart>
HWY_INLINE hn::Vec<F> weights_of_part(Weights weights) {
  constexpr hn::Rebind<int32_t, F> kWhole;
  const auto shifted = hn::ShiftRightBytes<static_cast<int>(kPart * kWidth * 2)>(kWeights, weights);
  return hn::PromoteTo(kF, hn::PromoteTo(kWhole, first_lanes<kWidth>(shifted)));
}

struct Sums {
  hn::Vec<F> part[kParts];
};

template <size_t kPart = 0>
HWY_INLINE void add_group(Weights weights, const double* HWY_RESTRICT values, Sums& sums) {
  sums.part[kPart] =
      hn::MulAdd(weights_of_part<kPart>(weights), hn::LoadU(kF, values + kPart * kWidth), sums.part[kPart]);
  if constexpr (kPart + 1 < kParts) add_group<kPart + 1>(weights, values, sums);
}

HWY_INLINE double total_of(const Sums& sums, const Sums& others) {
  hn::Vec<F> total = hn::Add(sums.part[0], others.part[0]);
  for (size_t p = 1; p < kParts; ++p) total = hn::Add(total, hn::Add(sums.part[p], others.part[p]));
  return hn::GetLane(hn::SumOfLanes(kF, total));
}

void gather_block(const BlockView& block, const double* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const uint16_t* HWY_RESTRICT code = block.codes;
  const uint16_t* HWY_RESTRICT weight = block.weights;
  for (size_t row = 0; row < block.rows.size(); ++row) {
    Sums sums, others;  // two chains of additions, taken in turn
    for (size_t p = 0; p < kParts; ++p) sums.part[p] = others.part[p] = hn::Zero(kF);
    const double* HWY_RESTRICT at = values + size_t{first_group(block.rows[row], block.anchor)} * kLanes;
    for (; *code != 0; ++code) {
      const uint32_t columns = *code >> 8;
      at += groups_ahead(*code) * kLanes;
      const auto packed = hn::BitCast(kBytes, hn::LoadU(kWeights, weight));
      const auto spread = hn::TableLookupBytesOr0(packed, hn::Load(kBytes, kSpread[columns].data()));
      weight += std::popcount(columns);
      const Sums last = sums;
      add_group(hn::BitCast(kWeights, spread), at, others);
      sums = others;
      others = last;
    }
    ++code;
    out[row] = total_of(sums, others) * quantum_of(block.rows[row]);
  }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hemibake {

HWY_EXPORT(gather_block);

void gather(const Links& links, std::span<const double> values, std::span<double> out) {
  expect_equal(values.size(), size_t{links.columns}, "values given to gather");
  expect_equal(out.size(), size_t{links.rows}, "results asked of gather");
  // Groups are read whole.
  std::vector<double> padded;
  if (values.size() % kLanes != 0) {
    padded.assign(values.begin(), values.end());
    padded.resize((values.size() + kLanes - 1) / kLanes * kLanes);
    values = padded;
  }
  parallel_for(links.blocks.size(), 1, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      HWY_DYNAMIC_DISPATCH(gather_block)
      (view_block(links.blocks[b]), values.data(), out.data() + b * Links::kRowsPerBlock);
      close_view(links.blocks[b]);
    }
  });
}

}  // namespace hemibake
#endif  // HWY_ONCE
