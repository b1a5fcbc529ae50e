// Form-factor links as a sparse matrix: row = receiver, column = patch, packed: about three bytes a link.
//
// Columns fall into groups of 8 neighbours. A row is a list of the groups it links to, ascending: for each,
// how many groups it lies after the one before, and 8 bits that say which of its columns have a link; then
// the weights of all its links as whole multiples of the row's quantum, 1..65535. The multiples are rounded
// by the largest remainder, so that their sum times the quantum is the sum of the weights given (to 2⁻³⁶ of
// it), and no weight is off by a quantum or more; links that round to nothing are not stored. The quantum is
// at most (1 + 1/65535) times the largest weight over 65535.
//
// Rows are kept in blocks of equal length, so that threads fill blocks independently and nothing is copied to
// join them.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "tracers/tracer.h"

namespace hemibake {

class SpillFile;

struct PackedRow {
  std::array<uint16_t, 3> quantum;  // the upper 48 bits of a double, lowest first
  int16_t start;                    // first group, from the block's anchor; INT16_MIN: group 0
};

// In `codes`, each group of a row: low byte the step from the group before (or from `start`), high byte the
// columns. No columns: a step of 256 times as much; no step either: the end of the row.
struct LinkBlock {
  uint32_t anchor = 0;  // a group near those of the block's rows
  std::vector<PackedRow> rows;
  std::vector<uint16_t> codes;
  // With zeros after the last, so that as many as a group has columns can be read from any link on.
  std::vector<uint16_t> weights = std::vector<uint16_t>(kColumnsPerGroup - 1);

  // Where the three lie one after another, once they are spilled and the vectors empty.
  struct Spilled {
    const std::byte* bytes = nullptr;
    size_t rows = 0, codes = 0, weights = 0;  // how many
  } spilled;

  static constexpr uint32_t kColumnsPerGroup = 8;
  size_t row_count() const { return spilled.bytes ? spilled.rows : rows.size(); }
  uint64_t link_count() const {
    return (spilled.bytes ? spilled.weights : weights.size()) - (kColumnsPerGroup - 1);
  }
};

struct Links {
  static constexpr uint32_t kRowsPerBlock = 1024;

  uint32_t rows = 0;
  uint32_t columns = 0;              // at most 2³¹
  std::vector<LinkBlock> blocks;     // ⌈rows / kRowsPerBlock⌉, each with kRowsPerBlock rows but the last
  std::shared_ptr<SpillFile> spill;  // where finished blocks go; none: they stay in memory

  bool empty() const { return blocks.empty(); }
  uint64_t count() const;       // stored links
  size_t stored_bytes() const;  // all in, in memory or spilled
};

inline double quantum_of(const PackedRow& row) {
  const auto& q = row.quantum;
  return std::bit_cast<double>(uint64_t{q[2]} << 48 | uint64_t{q[1]} << 32 | uint64_t{q[0]} << 16);
}

inline uint32_t first_group(const PackedRow& row, uint32_t anchor) {
  if (row.start == std::numeric_limits<int16_t>::min()) return 0;
  return static_cast<uint32_t>(int64_t{anchor} + row.start);
}

// Groups that a code, not the end of a row, leads on.
inline size_t groups_ahead(uint16_t code) {
  const size_t step = code & 255;
  return step << (code > 255 ? 0 : 8);
}

// Rows `rows`, nothing linked yet.
Links make_links(uint32_t rows, uint32_t columns, std::shared_ptr<SpillFile> spill = nullptr);

// Appends the next row of a block. row: ascending by patch, each patch once; weights finite, Σ > 0 or no link
// is stored, weights below 0 (rounding of an almost empty row) become 0. Throws std::logic_error where a
// weight is not finite or patches do not ascend.
void append_row(LinkBlock& block, std::span<const Link> row);

// Bytes of what the block's rows hold, in memory or spilled.
size_t stored_bytes(const LinkBlock& block);

// No more rows come to block `index`: gives back the memory left over, or spills the block. Throws InputError
// where the disk is full.
void finish_block(Links& links, size_t index);

// A block wherever it lies. Its rows come one after another: codes and weights are found only in order.
struct BlockView {
  uint32_t anchor;
  std::span<const PackedRow> rows;
  const uint16_t* codes;
  const uint16_t* weights;
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

// out[i] = Σ_j w_ij · values[j] in double, in an order that depends on the machine's vectors but not on the
// threads. values: one per column; out: one per row.
void gather(const Links& links, std::span<const double> values, std::span<double> out);

// Σ_j w_ij of every row, double: exact but for the quantum's own rounding.
std::vector<double> row_sums(const Links& links);

}  // namespace hemibake
