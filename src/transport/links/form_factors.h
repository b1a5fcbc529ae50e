// A sparse form-factor matrix: row = receiver, column = patch, packed to about three bytes an entry.
//
// Weights are whole multiples of their row's quantum. Weights that are multiples of a common unit already
// (rays that count alike, and files read back) are kept exactly. Others are rounded by the largest remainder:
// no weight is off by a quantum or more, and entries that round to zero are not stored. With T the sum of a
// row's multiples the error of its light is about sum · √(entries / 12) / T times the spread of the light it
// sees; T = 300 · sum · √entries makes that 1/1000. T is 12 to 64 per entry, but at least 4096 in rows with a
// weight above ½.
//
// Stores each row's sum in 24 bits; quantum = sum / T conserves energy whatever the multiples are. Rows whose
// sum is less than half of its last bit store nothing, and empty rows take no memory.
//
// An entry is a code of 16 bits: the lowest `weight_bits` of its block hold the multiple, the others the step
// from the row's column before, or from the column before its start: at least 1. A larger step takes a code
// with weight 0 before it, whose step counts as many times as the largest step; a larger multiple takes a
// code with step 0 after it, whose weight counts as many times as the largest weight. A block's rows are
// sorted by falling length and sixteen of them interleaved, code by code, so that one vector decodes a code
// of each and no sum runs across a vector.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tracers/tracer.h"

namespace hemibake {

class SpillFile;

// Rows that are appended and not packed yet.
struct OpenRows {
  std::vector<FormFactor> entries;  // of all rows
  std::vector<uint32_t> ends;       // of every row in `entries`
};

struct FormFactorBlock {
  static constexpr uint32_t kInterleavedRows = 16;
  static constexpr int kCodeBits = 16;
  // Zeros at the end: vectors are read whole.
  static constexpr uint32_t kPadding = kInterleavedRows * sizeof(uint16_t);

  uint32_t rows = 0;
  uint32_t entries = 0;      // stored, over all rows
  uint32_t codes = 0;        // of all entries
  uint32_t longest = 0;      // codes of the longest row
  uint32_t base = 0;         // column; rows start at multiples of 2^start_shift after it
  int16_t sum_exponent = 0;  // sums of rows are multiples of 2^sum_exponent
  uint8_t start_shift = 0, weight_bits = 0;
  std::vector<std::byte> packed;       // as BlockView reads it; empty if spilled
  const std::byte* spilled = nullptr;  // the same bytes in the spill file
  size_t packed_bytes = 0;             // of either

  std::unique_ptr<OpenRows> open;  // until the block is finished
};

struct FormFactorMatrix {
  static constexpr uint32_t kRowsPerBlock = 256;

  uint32_t rows = 0;
  uint32_t columns = 0;                 // at most 2³¹
  std::vector<FormFactorBlock> blocks;  // ⌈rows / kRowsPerBlock⌉, each with kRowsPerBlock rows but the last
  std::shared_ptr<SpillFile> spill;     // where finished blocks go; none: they stay in memory

  bool empty() const { return blocks.empty(); }
  uint64_t count() const;       // stored entries
  size_t stored_bytes() const;  // in memory and spilled
};

// Makes a matrix without entries. rows, columns: its shape. spill: see FormFactorMatrix.
FormFactorMatrix make_form_factors(uint32_t rows, uint32_t columns,
                                   std::shared_ptr<SpillFile> spill = nullptr);

// Appends the next row of a block. Throws std::logic_error if a weight is not finite or patches do not
// ascend. row: ascending by patch, each patch once. Weights below 0 (rounding of an almost empty row) become
// 0; a row with Σ ≤ 0 stores nothing.
void append_row(FormFactorBlock& block, std::span<const FormFactor> row);

// Packs block `index`, which has all its rows, and spills it if the matrix spills. Throws InputError if the
// disk is full.
void finish_block(FormFactorMatrix& form_factors, size_t index);
void finish_blocks(FormFactorMatrix& form_factors);

// Reads a finished block in memory or in the spill file. A row's place is its index in the order of the
// block, by falling length.
struct BlockView {
  uint32_t rows;
  uint32_t filled;  // rows with entries: only they have places
  uint32_t base;
  int start_shift, weight_bits;
  double sum_unit;
  const uint16_t* rows_as_long;  // [k]: rows with more than k codes; 0 at the end
  // By groups of sixteen places, in each the first codes of all, then the second codes of all that have one,
  // …. Little-endian.
  const uint16_t* codes;
  const uint16_t* sum_low;  // [filled], of every place: sum in units of `sum_unit`, less 1
  const uint8_t* sum_high;
  const uint8_t* row;    // of every place
  const uint8_t* start;  // of every place: column (start << start_shift) + base

  double sum(uint32_t place) const { return ((sum_high[place] << 16 | sum_low[place]) + 1) * sum_unit; }
  // Returns the column before the first one of a row; wraps around below 0.
  uint32_t before_start(uint32_t place) const { return base + (uint32_t{start[place]} << start_shift) - 1; }
};
BlockView view_block(const FormFactorBlock& block);
// Gives the memory of a spilled block back after its view was used.
void close_view(const FormFactorBlock& block);

// A block's rows as CSR, weights as packed: row i has [row_begin[i], row_begin[i + 1]).
struct BlockRows {
  std::vector<uint32_t> row_begin;
  std::vector<uint32_t> columns;
  std::vector<float> weights;
};
void unpack_block(const FormFactorBlock& block, BlockRows& rows);

// Calls visit(row, its patches, their weights) for every row of block `index`, ascending.
template <class Visit>
void visit_rows(const FormFactorMatrix& form_factors, size_t index, const Visit& visit) {
  BlockRows rows;
  unpack_block(form_factors.blocks[index], rows);
  for (size_t i = 0; i + 1 < rows.row_begin.size(); ++i) {
    const size_t begin = rows.row_begin[i], count = rows.row_begin[i + 1] - begin;
    visit(static_cast<uint32_t>(index * FormFactorMatrix::kRowsPerBlock + i),
          std::span<const uint32_t>(rows.columns).subspan(begin, count),
          std::span<const float>(rows.weights).subspan(begin, count));
  }
}

// Multiplies: out[i] = Σ_j w_ij · values[j], values rounded to float, products and sums in double. The same
// bytes on every machine and at any thread count. values: one per column. out: one per row.
void multiply(const FormFactorMatrix& form_factors, std::span<const double> values, std::span<double> out);

// Returns Σ_j w_ij of every row, to half of 2⁻²⁴ of the least power of two that no sum of its block exceeds.
std::vector<double> row_sums(const FormFactorMatrix& form_factors);

}  // namespace hemibake
