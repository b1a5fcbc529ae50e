// Form-factor links as a sparse matrix: row = receiver, column = patch, packed: about three bytes a link.
//
// Weights are whole multiples of their row's quantum. Where they are multiples of a common unit already (rays
// that count alike, and links read back) they stay what they are. Others are rounded by the largest
// remainder, so that the multiples times the quantum add up to the sum of the weights given; no weight is off
// by a quantum or more, and links that round to nothing are not stored. How fine: the error of a row's light
// is about sum · √(links / 12) / T times the spread of the light it sees, T being the sum of its multiples;
// with T = 200 · sum · √links that is 1/700 of the spread in every row, and 10⁻⁵ to 10⁻⁴ of π in a bake's
// totals (measured, tests/bench/coding_bench.cpp). T is 12 to 64 for each link, but at
// least 4096 in rows with a weight above ½.
//
// A link is 24 bits: the lowest `weight_bits` of its block hold the multiple, the others the step from the
// row's column before. A multiple that is too large goes on in links without a step, a step that is too large
// in links without weight. Rows lie side by side: a block's rows are sorted by falling length, sixteen of
// them take turns, link by link, so that one vector decodes a link of each and no sum runs across a vector.
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
  std::vector<Link> links;
  std::vector<uint32_t> ends;
};

struct LinkBlock {
  static constexpr uint32_t kRowsInTurn = 16;
  static constexpr uint32_t kLinkBytes = 3;
  static constexpr uint32_t kLinkBits = 8 * kLinkBytes;
  // Zeros after the last link: vectors are read whole.
  static constexpr uint32_t kPadding = kRowsInTurn * kLinkBytes;

  uint32_t rows = 0;
  uint32_t links = 0;    // columns with a weight, over all rows
  uint32_t longest = 0;  // row, in links as packed
  uint32_t quanta = 0;   // different ones, if fewer than rows, or one for each row
  uint32_t base = 0;     // column; rows start from multiples of 2^start_shift after it
  uint8_t start_shift = 0, weight_bits = 0;
  std::vector<std::byte> packed;       // what BlockView shows; empty once it is spilled
  const std::byte* spilled = nullptr;  // the same
  size_t packed_bytes = 0;

  std::unique_ptr<OpenRows> open;  // until the block is finished
};

struct Links {
  static constexpr uint32_t kRowsPerBlock = 256;

  uint32_t rows = 0;
  uint32_t columns = 0;              // at most 2³¹
  std::vector<LinkBlock> blocks;     // ⌈rows / kRowsPerBlock⌉, each with kRowsPerBlock rows but the last
  std::shared_ptr<SpillFile> spill;  // where finished blocks go; none: they stay in memory

  bool empty() const { return blocks.empty(); }
  uint64_t count() const;       // stored links: columns with a weight
  size_t stored_bytes() const;  // all in, in memory or spilled
};

// Rows `rows`, nothing linked yet.
Links make_links(uint32_t rows, uint32_t columns, std::shared_ptr<SpillFile> spill = nullptr);

// Appends the next row of a block. row: ascending by patch, each patch once; weights finite, Σ > 0 or no link
// is stored, weights below 0 (rounding of an almost empty row) become 0. Throws std::logic_error where a
// weight is not finite or patches do not ascend.
void append_row(LinkBlock& block, std::span<const Link> row);

// No more rows come to block `index`, which has all of them: packs it, and spills it where links are spilled.
// Throws InputError where the disk is full.
void finish_block(Links& links, size_t index);
void finish_blocks(Links& links);  // all of them

// A finished block wherever it lies. Place: of a row in the order of the block, by falling length.
struct BlockView {
  uint32_t rows;
  uint32_t base, start_shift, weight_bits;
  const float* quanta;           // of every place, or
  const uint8_t* quantum_index;  // not null: of every place, the index in `quanta`
  const uint16_t* rows_as_long;  // [k]: rows with more than k links as packed; 0 at the end
  const uint8_t* row;            // of every place
  const uint8_t* start;          // of every place: column (start << start_shift) + base
  // Sixteen places after sixteen places, in each the first link of all, the second of all that have one, …:
  // of those links the low 16 bits, then the high 8 bits. Little-endian.
  const uint8_t* links;

  double quantum(uint32_t place) const {
    return static_cast<double>(quanta[quantum_index ? quantum_index[place] : place]);
  }
};
BlockView view_block(const LinkBlock& block);
// The view is not needed any more: memory of a spilled block is given back.
void close_view(const LinkBlock& block);

// The links of a block's rows, weights as packed: row i has [row_begin[i], row_begin[i + 1]).
struct BlockRows {
  std::vector<uint32_t> row_begin;
  std::vector<uint32_t> patches;
  std::vector<float> weights;
};
void unpack_block(const LinkBlock& block, BlockRows& rows);

// out[i] = Σ_j w_ij · values[j], values rounded to float, products and sums in double: the same numbers on
// every machine and at any thread count. values: one per column; out: one per row.
void gather(const Links& links, std::span<const double> values, std::span<double> out);

// Σ_j w_ij of every row, double: exact but for the quantum's own rounding to float.
std::vector<double> row_sums(const Links& links);

}  // namespace hemibake
