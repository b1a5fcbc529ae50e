// The product of packed links and values: a vector takes a link of each of sixteen rows at once, so that
// decoding and sums need no exchange between lanes.
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#include "core/error.h"
#include "core/parallel.h"
#include "transport/links.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/links_gather.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr uint32_t kTurn = LinkBlock::kRowsInTurn;

#if HWY_TARGET == HWY_SCALAR

// A machine without vectors: the same, a link at a time.
void gather_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const uint8_t* HWY_RESTRICT link = block.links;
  const uint32_t weight_mask = (1u << block.weight_bits) - 1;
  for (uint32_t first = 0; first < block.rows; first += kTurn) {
    uint32_t column[kTurn] = {};
    double sum[kTurn] = {};
    const uint32_t places = std::min(kTurn, block.rows - first);
    for (uint32_t i = 0; i < places; ++i)
      column[i] = block.base + (uint32_t{block.start[first + i]} << block.start_shift);
    for (uint32_t k = 0; block.rows_as_long[k] > first; ++k) {
      const uint32_t turn = std::min(kTurn, block.rows_as_long[k] - first);
      for (uint32_t i = 0; i < turn; ++i) {
        const uint32_t code = link[2 * i] | link[2 * i + 1] << 8 | link[2 * turn + i] << 16;
        column[i] += code >> block.weight_bits;
        sum[i] += static_cast<double>(code & weight_mask) * static_cast<double>(values[column[i]]);
      }
      link += turn * LinkBlock::kLinkBytes;
    }
    for (uint32_t i = 0; i < places; ++i) out[block.row[first + i]] = sum[i] * block.quantum(first + i);
  }
}

#else

using F = hn::CappedTag<float, kTurn>;
constexpr F kF;
constexpr hn::RebindToUnsigned<F> kU;
constexpr hn::RebindToSigned<F> kI;
constexpr hn::Half<F> kHalfF;
constexpr hn::Half<hn::RebindToSigned<F> > kHalfI;
constexpr hn::Repartition<double, F> kD;
constexpr hn::Rebind<uint16_t, F> kLow;
constexpr hn::Rebind<uint8_t, F> kHigh;
constexpr size_t kWidth = hn::MaxLanes(F());
constexpr size_t kParts = kTurn / kWidth;
using U = hn::Vec<hn::RebindToUnsigned<F> >;
using D = hn::Vec<hn::Repartition<double, F> >;

// Some of the rows that take turns.
struct Part {
  U column;
  D low, high;  // sums
};

struct Decoder {
  U weight_mask;
  int weight_bits;
  const float* HWY_RESTRICT values;

  // The next link of each row: `links` from this part's low 16 bits on, the high ones at `high`; `lanes` of
  // them are there.
  HWY_INLINE void add_links(const uint8_t* low, const uint8_t* high, size_t lanes, Part& part) const {
    const auto upper = hn::PromoteTo(kU, hn::PromoteTo(kLow, hn::LoadU(kHigh, high)));
    const auto lower = hn::PromoteTo(kU, hn::LoadU(kLow, reinterpret_cast<const uint16_t*>(low)));
    const U code = hn::IfThenElseZero(hn::FirstN(kU, lanes), hn::Or(lower, hn::ShiftLeft<16>(upper)));
    part.column = hn::Add(part.column, hn::ShiftRightSame(code, weight_bits));
    const auto weight = hn::BitCast(kI, hn::And(code, weight_mask));
    const auto light = hn::GatherIndex(kF, values, hn::BitCast(kI, part.column));
    part.low = hn::MulAdd(hn::PromoteTo(kD, hn::LowerHalf(kHalfI, weight)),
                          hn::PromoteTo(kD, hn::LowerHalf(kHalfF, light)), part.low);
    part.high = hn::MulAdd(hn::PromoteTo(kD, hn::UpperHalf(kHalfI, weight)),
                           hn::PromoteTo(kD, hn::UpperHalf(kHalfF, light)), part.high);
  }
};

HWY_INLINE size_t lanes_from(size_t lane, size_t count) { return count > lane ? count - lane : 0; }

void gather_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const Decoder decoder{hn::Set(kU, (1u << block.weight_bits) - 1), static_cast<int>(block.weight_bits),
                        values};
  const uint8_t* HWY_RESTRICT link = block.links;
  HWY_ALIGN double sums[Links::kRowsPerBlock];
  for (uint32_t first = 0; first < block.rows; first += kTurn) {
    Part parts[kParts];
    for (size_t p = 0; p < kParts; ++p) {
      // Lanes without a row stay at the block's base.
      const auto bytes = hn::LoadU(kHigh, block.start + first + p * kWidth);
      const U start = hn::IfThenElseZero(hn::FirstN(kU, lanes_from(first + p * kWidth, block.rows)),
                                         hn::PromoteTo(kU, hn::PromoteTo(kLow, bytes)));
      parts[p].column =
          hn::Add(hn::Set(kU, block.base), hn::ShiftLeftSame(start, static_cast<int>(block.start_shift)));
      parts[p].low = parts[p].high = hn::Zero(kD);
    }
    for (const uint16_t* HWY_RESTRICT as_long = block.rows_as_long; *as_long > first; ++as_long) {
      const size_t turn = std::min<size_t>(kTurn, *as_long - first);
      for (size_t p = 0; p < kParts && p * kWidth < turn; ++p)
        decoder.add_links(link + 2 * p * kWidth, link + 2 * turn + p * kWidth, turn - p * kWidth, parts[p]);
      link += turn * LinkBlock::kLinkBytes;
    }
    for (size_t p = 0; p < kParts; ++p) {
      hn::Store(parts[p].low, kD, sums + first + p * kWidth);
      hn::Store(parts[p].high, kD, sums + first + p * kWidth + kWidth / 2);
    }
  }
  for (uint32_t place = 0; place < block.rows; ++place)
    out[block.row[place]] = sums[place] * block.quantum(place);
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hemibake {

HWY_EXPORT(gather_block);

namespace {

constexpr size_t kGrain = 16384;
// Blocks taken together: a block alone is some microseconds of work.
constexpr size_t kBlocksPerTask = 8;

struct Free {
  void operator()(float* memory) const { std::free(memory); }
};

// Values as float, in few large pages where the system has them: links lead all over the values, and a page
// for every 4 KiB of them would be looked up for almost every link.
std::unique_ptr<float[], Free> as_float(std::span<const double> values) {
  constexpr size_t kLargePage = size_t{2} << 20;
  const size_t wanted = std::max<size_t>(1, values.size()) * sizeof(float);
  const size_t bytes = wanted < kLargePage ? wanted : (wanted + kLargePage - 1) / kLargePage * kLargePage;
  std::unique_ptr<float[], Free> rounded(
      static_cast<float*>(bytes < kLargePage ? std::malloc(bytes) : std::aligned_alloc(kLargePage, bytes)));
  if (!rounded) throw std::bad_alloc();
  if (bytes >= kLargePage) madvise(rounded.get(), bytes, MADV_HUGEPAGE);
  parallel_for(values.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) rounded[i] = static_cast<float>(values[i]);
  });
  return rounded;
}

}  // namespace

void gather(const Links& links, std::span<const double> values, std::span<double> out) {
  expect_equal(values.size(), size_t{links.columns}, "values given to gather");
  expect_equal(out.size(), size_t{links.rows}, "results asked of gather");
  const auto rounded = as_float(values);
  parallel_for(links.blocks.size(), kBlocksPerTask, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      HWY_DYNAMIC_DISPATCH(gather_block)
      (view_block(links.blocks[b]), rounded.get(), out.data() + b * Links::kRowsPerBlock);
      close_view(links.blocks[b]);
    }
  });
}

}  // namespace hemibake
#endif  // HWY_ONCE
