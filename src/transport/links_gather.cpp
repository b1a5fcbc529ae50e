// The product of packed links and values: a vector takes a code of each of sixteen rows at once, so that
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

// A machine without vectors: the same, a code at a time.
void gather_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const uint16_t* HWY_RESTRICT code = block.codes;
  const uint32_t most_weight = (1u << block.weight_bits) - 1;
  const uint32_t most_step = (1u << (LinkBlock::kCodeBits - block.weight_bits)) - 1;
  for (uint32_t first = 0; first < block.rows; first += kTurn) {
    uint32_t column[kTurn] = {}, total[kTurn] = {};
    double sum[kTurn] = {};
    const uint32_t places = std::min(kTurn, block.rows - first);
    for (uint32_t i = 0; i < places; ++i) column[i] = block.before_start(first + i);
    for (uint32_t k = 0; block.rows_as_long[k] > first; ++k) {
      const uint32_t turn = std::min(kTurn, block.rows_as_long[k] - first);
      for (uint32_t i = 0; i < turn; ++i, ++code) {
        const uint32_t step = *code >> block.weight_bits, part = *code & most_weight;
        column[i] += part == 0 ? step * most_step : step;
        if (part == 0) continue;
        const uint32_t weight = step == 0 ? part * most_weight : part;
        total[i] += weight;
        sum[i] += static_cast<double>(weight) * static_cast<double>(values[column[i]]);
      }
    }
    for (uint32_t i = 0; i < places; ++i)
      out[block.row[first + i]] = sum[i] * (block.sum(first + i) / std::max(1u, total[i]));
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
constexpr hn::Rebind<uint16_t, F> kCode;
constexpr hn::Rebind<uint8_t, F> kByte;
constexpr size_t kWidth = hn::MaxLanes(F());
constexpr size_t kParts = kTurn / kWidth;
using U = hn::Vec<hn::RebindToUnsigned<F> >;
using D = hn::Vec<hn::Repartition<double, F> >;

// Some of the rows that take turns.
struct Part {
  U column, total;
  D low, high;  // sums
};

struct Decoder {
  U most_weight;
  int weight_bits;
  const float* HWY_RESTRICT values;

  // The next code of each row; `lanes` of them are there.
  HWY_INLINE void add_links(const uint16_t* codes, size_t lanes, Part& part) const {
    const U code = hn::IfThenElseZero(hn::FirstN(kU, lanes), hn::PromoteTo(kU, hn::LoadU(kCode, codes)));
    const U step = hn::ShiftRightSame(code, weight_bits), weight = hn::And(code, most_weight);
    const auto is_far = hn::Eq(weight, hn::Zero(kU)), is_large = hn::Eq(step, hn::Zero(kU));
    // Times the largest step, times the largest weight.
    const U far = hn::Sub(hn::ShiftLeftSame(step, LinkBlock::kCodeBits - weight_bits), step);
    const U large = hn::Sub(hn::ShiftLeftSame(weight, weight_bits), weight);
    const U multiple = hn::IfThenElse(is_large, large, weight);
    part.column = hn::Add(part.column, hn::IfThenElse(is_far, far, step));
    part.total = hn::Add(part.total, multiple);
    // What has no weight reads the first value: it is at hand, and a row without codes has no column.
    const U index = hn::IfThenZeroElse(is_far, part.column);
    const auto times = hn::BitCast(kI, multiple);
    const auto light = hn::GatherIndex(kF, values, hn::BitCast(kI, index));
    part.low = hn::MulAdd(hn::PromoteTo(kD, hn::LowerHalf(kHalfI, times)),
                          hn::PromoteTo(kD, hn::LowerHalf(kHalfF, light)), part.low);
    part.high = hn::MulAdd(hn::PromoteTo(kD, hn::UpperHalf(kHalfI, times)),
                           hn::PromoteTo(kD, hn::UpperHalf(kHalfF, light)), part.high);
  }
};

void gather_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const Decoder decoder{hn::Set(kU, (1u << block.weight_bits) - 1), block.weight_bits, values};
  const uint16_t* HWY_RESTRICT codes = block.codes;
  HWY_ALIGN double sums[Links::kRowsPerBlock];
  HWY_ALIGN uint32_t totals[Links::kRowsPerBlock];
  for (uint32_t first = 0; first < block.rows; first += kTurn) {
    Part parts[kParts];
    for (size_t p = 0; p < kParts; ++p) {
      const U start =
          hn::PromoteTo(kU, hn::PromoteTo(kCode, hn::LoadU(kByte, block.start + first + p * kWidth)));
      parts[p].column = hn::Add(hn::Set(kU, block.base - 1), hn::ShiftLeftSame(start, block.start_shift));
      parts[p].total = hn::Zero(kU);
      parts[p].low = parts[p].high = hn::Zero(kD);
    }
    for (const uint16_t* HWY_RESTRICT as_long = block.rows_as_long; *as_long > first; ++as_long) {
      const size_t turn = std::min<size_t>(kTurn, *as_long - first);
      for (size_t p = 0; p < kParts && p * kWidth < turn; ++p)
        decoder.add_links(codes + p * kWidth, turn - p * kWidth, parts[p]);
      codes += turn;
    }
    for (size_t p = 0; p < kParts; ++p) {
      hn::Store(parts[p].total, kU, totals + first + p * kWidth);
      hn::Store(parts[p].low, kD, sums + first + p * kWidth);
      hn::Store(parts[p].high, kD, sums + first + p * kWidth + kWidth / 2);
    }
  }
  for (uint32_t place = 0; place < block.rows; ++place)
    out[block.row[place]] = sums[place] * (block.sum(place) / std::max(1u, totals[place]));
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
