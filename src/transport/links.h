// Form-factor links as a sparse matrix: row = receiver, column = patch, in compressed sparse rows (CSR). Rows
// are kept in blocks of equal length, so that threads fill blocks independently and nothing is copied to join
// them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tracers/tracer.h"

namespace hemibake {

struct LinkBlock {
  std::vector<uint32_t> row_begin;  // rows in this block + 1; into patches and weights
  std::vector<uint32_t> patches;
  std::vector<float> weights;
};

struct Links {
  static constexpr uint32_t kRowsPerBlock = 1024;

  uint32_t rows = 0;
  uint32_t columns = 0;
  std::vector<LinkBlock> blocks;  // ⌈rows / kRowsPerBlock⌉, each with kRowsPerBlock rows but the last

  bool empty() const { return blocks.empty(); }
  uint64_t count() const;  // stored links
  size_t memory_bytes() const;
};

// Rows `rows`, nothing linked yet.
Links make_links(uint32_t rows, uint32_t columns);

// Appends the next row of a block.
void append_row(LinkBlock& block, std::span<const Link> row);

// out[i] = Σ_j w_ij · values[j], summed in double in the order stored. values: one per column; out: one per
// row.
void gather(const Links& links, std::span<const double> values, std::span<double> out);

// Σ_j w_ij of every row, double.
std::vector<double> row_sums(const Links& links);

}  // namespace hemibake
