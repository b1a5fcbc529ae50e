// Multiplies packed form factors by values: a vector takes a code of each of sixteen rows at once, so that
// decoding and sums need no exchange between lanes. Codes are decoded some steps before their values are
// needed, and the values prefetched: on smooth maps almost every entry reads a cache line of its own.
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

constexpr uint32_t kRows = FormFactorBlock::kInterleavedRows;

#if HWY_TARGET == HWY_SCALAR

// Multiplies a block without vectors, a code at a time.
void multiply_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  const uint16_t* HWY_RESTRICT code = block.codes;
  const uint32_t most_weight = (1u << block.weight_bits) - 1;
  const uint32_t most_step = (1u << (FormFactorBlock::kCodeBits - block.weight_bits)) - 1;
  std::fill(out, out + block.rows, 0.0);
  for (uint32_t first = 0; first < block.filled; first += kRows) {
    uint32_t column[kRows] = {}, total[kRows] = {};
    double sum[kRows] = {};
    const uint32_t places = std::min(kRows, block.filled - first);
    for (uint32_t i = 0; i < places; ++i) column[i] = block.before_start(first + i);
    for (uint32_t k = 0; block.rows_as_long[k] > first; ++k) {
      const uint32_t rows = std::min(kRows, block.rows_as_long[k] - first);
      for (uint32_t i = 0; i < rows; ++i, ++code) {
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

// Codes are decoded in the widest vectors, sums in vectors of up to four doubles.
constexpr hn::CappedTag<uint32_t, kRows> kU;
constexpr hn::RebindToSigned<decltype(kU)> kI;
constexpr hn::Rebind<uint16_t, decltype(kU)> kCode;
constexpr hn::Rebind<uint8_t, decltype(kU)> kByte;
constexpr size_t kWidth = hn::MaxLanes(kU);
constexpr size_t kParts = kRows / kWidth;
using U = hn::Vec<decltype(kU)>;

constexpr hn::CappedTag<double, 4> kD;
constexpr hn::Rebind<float, decltype(kD)> kLight;
constexpr hn::Rebind<int32_t, decltype(kD)> kMultiple;
constexpr size_t kSumWidth = hn::MaxLanes(kD);
constexpr size_t kSumParts = kRows / kSumWidth;

// Up to sixteen codes of each of sixteen rows, decoded.
struct DecodedCodes {
  static constexpr uint32_t kMost = 16;

  HWY_ALIGN uint32_t columns[kMost * kRows];
  HWY_ALIGN int32_t multiples[kMost * kRows];
  HWY_ALIGN uint32_t totals[kRows];  // of the multiples of each row, if `ends`
  uint32_t count;                    // codes of a row
  uint32_t first;                    // place of the group of rows
  bool ends;                         // at the end of the group
};

// Decodes the codes of a block in their order.
class Decoder {
 public:
  Decoder(const BlockView& block, const float* HWY_RESTRICT values)
      : block_(block),
        values_(values),
        most_weight_(hn::Set(kU, (1u << block.weight_bits) - 1)),
        codes_(block.codes) {
    begin_group(0);
  }

  // Decodes the next codes. Returns false if there are none left.
  HWY_INLINE bool next(DecodedCodes& decoded) {
    if (first_ >= block_.filled) return false;
    decoded.first = first_;
    for (decoded.count = 0; *as_long_ > first_ && decoded.count < DecodedCodes::kMost;
         ++decoded.count, ++as_long_) {
      const size_t rows = std::min<size_t>(kRows, *as_long_ - first_);
      uint32_t* const columns = decoded.columns + decoded.count * kRows;
      for (size_t p = 0; p < kParts; ++p)
        decode(p, rows > p * kWidth ? rows - p * kWidth : 0, columns,
               decoded.multiples + decoded.count * kRows);
      for (size_t i = 0; i < kRows; ++i) hwy::Prefetch(values_ + columns[i]);
      codes_ += rows;
      hwy::Prefetch(codes_ + kCodesAhead);
    }
    decoded.ends = *as_long_ <= first_;
    if (decoded.ends) {
      for (size_t p = 0; p < kParts; ++p) hn::Store(totals_[p], kU, decoded.totals + p * kWidth);
      begin_group(first_ + kRows);
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

  // Decodes the next code of each row of a part. lanes: rows that have one.
  HWY_INLINE void decode(size_t part, size_t lanes, uint32_t* columns, int32_t* multiples) {
    const U code = hn::IfThenElseZero(hn::FirstN(kU, lanes),
                                      hn::PromoteTo(kU, hn::LoadU(kCode, codes_ + part * kWidth)));
    const U step = hn::ShiftRightSame(code, block_.weight_bits), weight = hn::And(code, most_weight_);
    const auto is_far = hn::Eq(weight, hn::Zero(kU)), is_large = hn::Eq(step, hn::Zero(kU));
    // step · largest step, weight · largest weight.
    const U far = hn::Sub(hn::ShiftLeftSame(step, FormFactorBlock::kCodeBits - block_.weight_bits), step);
    const U large = hn::Sub(hn::ShiftLeftSame(weight, block_.weight_bits), weight);
    const U multiple = hn::IfThenElse(is_large, large, weight);
    columns_[part] = hn::Add(columns_[part], hn::IfThenElse(is_far, far, step));
    totals_[part] = hn::Add(totals_[part], multiple);
    // Codes without a weight read the first value, which is cached: a row without codes has no column.
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

// Sums the rows of a block, group by group.
class Sums {
 public:
  Sums(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out)
      : block_(block), values_(values), out_(out) {
    clear();
  }

  HWY_INLINE void add(const DecodedCodes& decoded) {
    for (uint32_t k = 0; k < decoded.count; ++k)
      for (size_t p = 0; p < kSumParts; ++p) {
        const size_t at = k * kRows + p * kSumWidth;
        const auto multiples = hn::PromoteTo(kD, hn::Load(kMultiple, decoded.multiples + at));
        sums_[p] = hn::MulAdd(multiples, hn::PromoteTo(kD, light_of(decoded.columns + at)), sums_[p]);
      }
    if (decoded.ends) end_group(decoded);
  }

 private:
  // Loads one by one: faster than a gather instruction on many machines.
  HWY_INLINE hn::Vec<decltype(kLight)> light_of(const uint32_t* HWY_RESTRICT columns) const {
    HWY_ALIGN float light[kSumWidth];
    for (size_t i = 0; i < kSumWidth; ++i) light[i] = values_[columns[i]];
    return hn::Load(kLight, light);
  }

  void clear() {
    for (size_t p = 0; p < kSumParts; ++p) sums_[p] = hn::Zero(kD);
  }

  void end_group(const DecodedCodes& decoded) {
    HWY_ALIGN double sums[kRows];
    for (size_t p = 0; p < kSumParts; ++p) hn::Store(sums_[p], kD, sums + p * kSumWidth);
    const uint32_t end = std::min(block_.filled, decoded.first + kRows);
    for (uint32_t place = decoded.first; place < end; ++place)
      out_[block_.row[place]] = sums[place - decoded.first] *
                                (block_.sum(place) / std::max(1u, decoded.totals[place - decoded.first]));
    clear();
  }

  const BlockView& block_;
  const float* HWY_RESTRICT values_;
  double* HWY_RESTRICT out_;
  hn::Vec<decltype(kD)> sums_[kSumParts];
};

void multiply_block(const BlockView& block, const float* HWY_RESTRICT values, double* HWY_RESTRICT out) {
  std::fill(out, out + block.rows, 0.0);  // rows without entries have no place
  Decoder decoder(block, values);
  Sums sums(block, values, out);
  DecodedCodes decoded[2];
  bool here = decoder.next(decoded[0]);
  for (size_t now = 0; here; now = 1 - now) {
    here = decoder.next(decoded[1 - now]);
    sums.add(decoded[now]);
  }
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hemibake {

HWY_EXPORT(multiply_block);

namespace {

constexpr size_t kGrain = 16384;
// Blocks per task: a block alone is some microseconds of work.
constexpr size_t kBlocksPerTask = 8;

LargePageVector<float> as_float(std::span<const double> values) {
  LargePageVector<float> rounded(std::max<size_t>(1, values.size()));
  parallel_for(values.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) rounded[i] = static_cast<float>(values[i]);
  });
  return rounded;
}

}  // namespace

void multiply(const FormFactorMatrix& form_factors, std::span<const double> values, std::span<double> out) {
  expect_equal(values.size(), size_t{form_factors.columns}, "values given to multiply");
  expect_equal(out.size(), size_t{form_factors.rows}, "results asked of multiply");
  const LargePageVector<float> rounded = as_float(values);
  parallel_for(form_factors.blocks.size(), kBlocksPerTask, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      HWY_DYNAMIC_DISPATCH(multiply_block)
      (view_block(form_factors.blocks[b]), rounded.data(), out.data() + b * FormFactorMatrix::kRowsPerBlock);
      close_view(form_factors.blocks[b]);
    }
  });
}

}  // namespace hemibake
#endif  // HWY_ONCE
