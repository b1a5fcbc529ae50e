// Form-factor links as a sparse matrix: row = receiver, column = patch, packed: about three bytes a link.
//
// Weights are whole multiples of their row's quantum. Where they are multiples of a common unit already (rays
// that count alike, and links read back) they stay what they are. Others are rounded by the largest
// remainder; no weight is off by a quantum or more, and links that round to nothing are not stored. How fine:
// the error of a row's light is about sum · √(links / 12) / T times the spread of the light it sees, T being
// the sum of its multiples; with T = 300 · sum · √links that is 1/1000 of the spread in every row, and 10⁻⁵
// to 10⁻⁴ of π in a bake's totals (measured, tests/bench/coding_bench.cpp). T is 12 to 64 for each link, but
// at least 4096 in rows with a weight above ½.
//
// What is kept of the weights' size is the sum of every row, in 24 bits: the quantum is that sum over T, so
// that no energy comes or goes whatever the multiples are. Rows whose sum is less than half of its last bit
// store nothing, and rows without links take no memory.
//
// A link is a code of 16 bits: the lowest `weight_bits` of its block hold the multiple, the others the step
// from the row's column before, or from the column before its start: at least 1. A larger step takes a code
// with weight 0 before it, whose step counts as many times as the largest step; a larger multiple takes a
// code with step 0 after it, whose weight counts as many times as the largest weight. Rows lie side by side:
// a block's rows are sorted by falling length, sixteen of them take turns, code by code, so that one vector
// decodes a code of each and no sum runs across a vector.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tracers/tracer.h"

namespace hemibake {

class SpillFile;

// Rows appended and not packed yet: the links of all, and where each row's end.
struct OpenRows {
  std::vector<FormFactor> links;
  std::vector<uint32_t> ends;
};

struct FormFactorBlock {
  static constexpr uint32_t kRowsInTurn = 16;
  static constexpr int kCodeBits = 16;
  // Zeros after all else: vectors are read whole.
  static constexpr uint32_t kPadding = kRowsInTurn * sizeof(uint16_t);

  uint32_t rows = 0;
  uint32_t links = 0;        // columns with a weight, over all rows
  uint32_t codes = 0;        // they take
  uint32_t longest = 0;      // row, in codes
  uint32_t base = 0;         // column; rows start at multiples of 2^start_shift after it
  int16_t sum_exponent = 0;  // sums of rows are multiples of 2^sum_exponent
  uint8_t start_shift = 0, weight_bits = 0;
  std::vector<std::byte> packed;       // what BlockView shows; empty once it is spilled
  const std::byte* spilled = nullptr;  // the same
  size_t packed_bytes = 0;

  std::unique_ptr<OpenRows> open;  // until the block is finished
};

struct FormFactorMatrix {
  static constexpr uint32_t kRowsPerBlock = 256;

  uint32_t rows = 0;
  uint32_t columns = 0;                 // at most 2³¹
  std::vector<FormFactorBlock> blocks;  // ⌈rows / kRowsPerBlock⌉, each with kRowsPerBlock rows but the last
  std::shared_ptr<SpillFile> spill;     // where finished blocks go; none: they stay in memory

  bool empty() const { return blocks.empty(); }
  uint64_t count() const;       // stored links: columns with a weight
  size_t stored_bytes() const;  // all in, in memory or spilled
};

// Rows `rows`, nothing linked yet.
FormFactorMatrix make_form_factors(uint32_t rows, uint32_t columns,
                                   std::shared_ptr<SpillFile> spill = nullptr);

// Appends the next row of a block. row: ascending by patch, each patch once; weights finite, Σ > 0 or no link
// is stored, weights below 0 (rounding of an almost empty row) become 0. Throws std::logic_error where a
// weight is not finite or patches do not ascend.
void append_row(FormFactorBlock& block, std::span<const FormFactor> row);

// No more rows come to block `index`, which has all of them: packs it, and spills it where links are spilled.
// Throws InputError where the disk is full.
void finish_block(FormFactorMatrix& links, size_t index);
void finish_blocks(FormFactorMatrix& links);  // all of them

// A finished block wherever it lies. Place: of a row in the order of the block, by falling length.
struct BlockView {
  uint32_t rows;
  uint32_t filled;  // rows that have links: they have the first places, and there are no more
  uint32_t base;
  int start_shift, weight_bits;
  double sum_unit;
  const uint16_t* rows_as_long;  // [k]: rows with more than k codes; 0 at the end
  // Sixteen places after sixteen places, in each the first code of all, the second of all that have one, ….
  // Little-endian.
  const uint16_t* codes;
  const uint16_t* sum_low;  // of every place, [filled]: sum in units of `sum_unit`, less 1
  const uint8_t* sum_high;
  const uint8_t* row;    // of every place
  const uint8_t* start;  // of every place: column (start << start_shift) + base

  double sum(uint32_t place) const { return ((sum_high[place] << 16 | sum_low[place]) + 1) * sum_unit; }
  // The column before the first one a row may lead to; wraps around below 0.
  uint32_t before_start(uint32_t place) const { return base + (uint32_t{start[place]} << start_shift) - 1; }
};
BlockView view_block(const FormFactorBlock& block);
// The view is not needed any more: memory of a spilled block is given back.
void close_view(const FormFactorBlock& block);

// The links of a block's rows, weights as packed: row i has [row_begin[i], row_begin[i + 1]).
struct BlockRows {
  std::vector<uint32_t> row_begin;
  std::vector<uint32_t> columns;
  std::vector<float> weights;
};
void unpack_block(const FormFactorBlock& block, BlockRows& rows);

// Calls visit(row, its patches, their weights) for the rows of block `index`, ascending.
template <class Visit>
void visit_rows(const FormFactorMatrix& links, size_t index, const Visit& visit) {
  BlockRows rows;
  unpack_block(links.blocks[index], rows);
  for (size_t i = 0; i + 1 < rows.row_begin.size(); ++i) {
    const size_t begin = rows.row_begin[i], count = rows.row_begin[i + 1] - begin;
    visit(static_cast<uint32_t>(index * FormFactorMatrix::kRowsPerBlock + i),
          std::span<const uint32_t>(rows.columns).subspan(begin, count),
          std::span<const float>(rows.weights).subspan(begin, count));
  }
}

// out[i] = Σ_j w_ij · values[j], values rounded to float, products and sums in double: the same numbers on
// every machine and at any thread count. values: one per column; out: one per row.
void multiply(const FormFactorMatrix& links, std::span<const double> values, std::span<double> out);

// Σ_j w_ij of every row: to half of 2⁻²⁴ of the least power of two that no sum of its block exceeds.
std::vector<double> row_sums(const FormFactorMatrix& links);

}  // namespace hemibake
