// The product of packed links and values: a vector takes a code of each of sixteen rows at once, so that
// decoding and sums need no exchange between lanes. Codes are decoded some turns before their values are
// asked for, and the values are fetched meanwhile: on smooth maps almost every link leads to a line of memory
// of its own.
#include <hwy/cache_control.h>

#include <algorithm>
#include <cstdint>

#include "core/error.h"
#include "core/large_pages.h"
#include "core/parallel.h"
#include "transport/links/form_factors.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transport/links/multiply.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr uint32_t kTurn = FormFactorBlock::kRowsInTurn;

#if HWY_TARGET == HWY_SCALAR

// A machine without vectors: the same, a code at a time.
void gather_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const uint16_t* HWY_RESTRICT code = block.codes;
  const uint32_t most_weight = (1u << block.weight_bits) - 1;
  const uint32_t most_step = (1u << (FormFactorBlock::kCodeBits - block.weight_bits)) - 1;
  std::fill(out, out + block.rows, 0.0);
  for (uint32_t first = 0; first < block.filled; first += kTurn) {
    uint32_t column[kTurn] = {}, total[kTurn] = {};
    double sum[kTurn] = {};
    const uint32_t places = std::min(kTurn, block.filled - first);
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

// Codes are decoded in vectors as wide as there are, sums are made in those of up to four numbers.
constexpr hn::CappedTag<uint32_t, kTurn> kU;
constexpr hn::RebindToSigned<decltype(kU)> kI;
constexpr hn::Rebind<uint16_t, decltype(kU)> kCode;
constexpr hn::Rebind<uint8_t, decltype(kU)> kByte;
constexpr size_t kWidth = hn::MaxLanes(kU);
constexpr size_t kParts = kTurn / kWidth;
using U = hn::Vec<decltype(kU)>;

constexpr hn::CappedTag<double, 4> kD;
constexpr hn::Rebind<float, decltype(kD)> kLight;
constexpr hn::Rebind<int32_t, decltype(kD)> kMultiple;
constexpr size_t kSumWidth = hn::MaxLanes(kD);
constexpr size_t kSumParts = kTurn / kSumWidth;

// Turns of a group of sixteen rows, decoded.
struct Turns {
  static constexpr uint32_t kMost = 16;

  HWY_ALIGN uint32_t columns[kMost * kTurn];
  HWY_ALIGN int32_t multiples[kMost * kTurn];
  HWY_ALIGN uint32_t totals[kTurn];  // of the multiples of each row, where `ends`
  uint32_t count;
  uint32_t first;  // place of the group
  bool ends;       // the group
};

// Walks through the codes of a block.
class Decoder {
 public:
  Decoder(const BlockView& block, const float* HWY_RESTRICT values)
      : block_(block),
        values_(values),
        most_weight_(hn::Set(kU, (1u << block.weight_bits) - 1)),
        codes_(block.codes) {
    begin_group(0);
  }

  // The next turns; false where there are none left.
  HWY_INLINE bool next(Turns& turns) {
    if (first_ >= block_.filled) return false;
    turns.first = first_;
    for (turns.count = 0; *as_long_ > first_ && turns.count < Turns::kMost; ++turns.count, ++as_long_) {
      const size_t turn = std::min<size_t>(kTurn, *as_long_ - first_);
      uint32_t* const columns = turns.columns + turns.count * kTurn;
      for (size_t p = 0; p < kParts; ++p)
        decode(p, turn > p * kWidth ? turn - p * kWidth : 0, columns, turns.multiples + turns.count * kTurn);
      for (size_t i = 0; i < kTurn; ++i) hwy::Prefetch(values_ + columns[i]);
      codes_ += turn;
      hwy::Prefetch(codes_ + kCodesAhead);
    }
    turns.ends = *as_long_ <= first_;
    if (turns.ends) {
      for (size_t p = 0; p < kParts; ++p) hn::Store(totals_[p], kU, turns.totals + p * kWidth);
      begin_group(first_ + kTurn);
    }
    return true;
  }

 private:
  static constexpr size_t kCodesAhead = 512;

  void begin_group(uint32_t first) {
    first_ = first;
    as_long_ = block_.rows_as_long;
    if (first >= block_.filled) return;
    for (size_t p = 0; p < kParts; ++p) {
      const U start =
          hn::PromoteTo(kU, hn::PromoteTo(kCode, hn::LoadU(kByte, block_.start + first + p * kWidth)));
      columns_[p] = hn::Add(hn::Set(kU, block_.base - 1), hn::ShiftLeftSame(start, block_.start_shift));
      totals_[p] = hn::Zero(kU);
    }
  }

  // The next code of each row of a part; `lanes` of them are there.
  HWY_INLINE void decode(size_t part, size_t lanes, uint32_t* columns, int32_t* multiples) {
    const U code = hn::IfThenElseZero(hn::FirstN(kU, lanes),
                                      hn::PromoteTo(kU, hn::LoadU(kCode, codes_ + part * kWidth)));
    const U step = hn::ShiftRightSame(code, block_.weight_bits), weight = hn::And(code, most_weight_);
    const auto is_far = hn::Eq(weight, hn::Zero(kU)), is_large = hn::Eq(step, hn::Zero(kU));
    // Times the largest step, times the largest weight.
    const U far = hn::Sub(hn::ShiftLeftSame(step, FormFactorBlock::kCodeBits - block_.weight_bits), step);
    const U large = hn::Sub(hn::ShiftLeftSame(weight, block_.weight_bits), weight);
    const U multiple = hn::IfThenElse(is_large, large, weight);
    columns_[part] = hn::Add(columns_[part], hn::IfThenElse(is_far, far, step));
    totals_[part] = hn::Add(totals_[part], multiple);
    // What has no weight reads the first value: it is at hand, and a row without codes has no column.
    hn::Store(hn::IfThenZeroElse(is_far, columns_[part]), kU, columns + part * kWidth);
    hn::Store(hn::BitCast(kI, multiple), kI, multiples + part * kWidth);
  }

  const BlockView& block_;
  const float* HWY_RESTRICT values_;
  U most_weight_;
  const uint16_t* HWY_RESTRICT codes_;
  const uint16_t* HWY_RESTRICT as_long_;
  uint32_t first_;
  U columns_[kParts], totals_[kParts];
};

// The rows of a block, group by group.
class Sums {
 public:
  Sums(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out)
      : block_(block), values_(values), out_(out) {
    clear();
  }

  HWY_INLINE void add(const Turns& turns) {
    for (uint32_t k = 0; k < turns.count; ++k)
      for (size_t p = 0; p < kSumParts; ++p) {
        const size_t at = k * kTurn + p * kSumWidth;
        const auto multiples = hn::PromoteTo(kD, hn::Load(kMultiple, turns.multiples + at));
        sums_[p] = hn::MulAdd(multiples, hn::PromoteTo(kD, light_of(turns.columns + at)), sums_[p]);
      }
    if (turns.ends) end_group(turns);
  }

 private:
  // One by one: that is faster than to gather where a gather is many small steps.
  HWY_INLINE hn::Vec<decltype(kLight)> light_of(const uint32_t* HWY_RESTRICT columns) const {
    HWY_ALIGN float light[kSumWidth];
    for (size_t i = 0; i < kSumWidth; ++i) light[i] = values_[columns[i]];
    return hn::Load(kLight, light);
  }

  void clear() {
    for (size_t p = 0; p < kSumParts; ++p) sums_[p] = hn::Zero(kD);
  }

  void end_group(const Turns& turns) {
    HWY_ALIGN double sums[kTurn];
    for (size_t p = 0; p < kSumParts; ++p) hn::Store(sums_[p], kD, sums + p * kSumWidth);
    const uint32_t end = std::min(block_.filled, turns.first + kTurn);
    for (uint32_t place = turns.first; place < end; ++place)
      out_[block_.row[place]] =
          sums[place - turns.first] * (block_.sum(place) / std::max(1u, turns.totals[place - turns.first]));
    clear();
  }

  const BlockView& block_;
  const float* HWY_RESTRICT values_;
  double* HWY_RESTRICT out_;
  hn::Vec<decltype(kD)> sums_[kSumParts];
};

void gather_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  std::fill(out, out + block.rows, 0.0);  // rows without links have no place
  Decoder decoder(block, values);
  Sums sums(block, values, out);
  Turns turns[2];
  bool here = decoder.next(turns[0]);
  for (size_t now = 0; here; now = 1 - now) {
    here = decoder.next(turns[1 - now]);
    sums.add(turns[now]);
  }
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

LargePageVector<float> as_float(std::span<const double> values) {
  LargePageVector<float> rounded(std::max<size_t>(1, values.size()));
  parallel_for(values.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) rounded[i] = static_cast<float>(values[i]);
  });
  return rounded;
}

}  // namespace

void multiply(const FormFactorMatrix& links, std::span<const double> values, std::span<double> out) {
  expect_equal(values.size(), size_t{links.columns}, "values given to gather");
  expect_equal(out.size(), size_t{links.rows}, "results asked of gather");
  const LargePageVector<float> rounded = as_float(values);
  parallel_for(links.blocks.size(), kBlocksPerTask, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      HWY_DYNAMIC_DISPATCH(gather_block)
      (view_block(links.blocks[b]), rounded.data(), out.data() + b * FormFactorMatrix::kRowsPerBlock);
      close_view(links.blocks[b]);
    }
  });
}

}  // namespace hemibake
#endif  // HWY_ONCE
