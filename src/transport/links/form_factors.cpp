#include "transport/links/form_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "transport/links/pack.h"
#include "transport/links/spill_file.h"

namespace hemibake {
namespace {

const std::byte* packed_bytes(const FormFactorBlock& block) {
  return block.spilled ? block.spilled : block.packed.data();
}

// Calls visit(row in the block, column, part of the multiple of the row's quantum) for every code with a
// weight, those of a row in their order.
template <class Visit>
void visit_packed(const BlockView& view, const Visit& visit) {
  const uint32_t most_weight = (1u << view.weight_bits) - 1;
  const uint32_t most_step = (1u << (FormFactorBlock::kCodeBits - view.weight_bits)) - 1;
  const uint16_t* code = view.codes;
  for (uint32_t first = 0; first < view.filled; first += FormFactorBlock::kInterleavedRows) {
    uint32_t column[FormFactorBlock::kInterleavedRows];
    for (uint32_t i = 0; i < FormFactorBlock::kInterleavedRows && first + i < view.filled; ++i)
      column[i] = view.before_start(first + i);
    for (uint32_t k = 0; view.rows_as_long[k] > first; ++k) {
      const uint32_t rows = std::min(FormFactorBlock::kInterleavedRows, view.rows_as_long[k] - first);
      for (uint32_t i = 0; i < rows; ++i, ++code) {
        const uint32_t step = *code >> view.weight_bits, weight = *code & most_weight;
        column[i] += weight == 0 ? step * most_step : step;
        if (weight > 0) visit(view.row[first + i], column[i], step == 0 ? weight * most_weight : weight);
      }
    }
  }
}

}  // namespace

uint64_t FormFactorMatrix::count() const {
  uint64_t entries = 0;
  for (const FormFactorBlock& block : blocks) entries += block.entries;
  return entries;
}

size_t FormFactorMatrix::stored_bytes() const {
  size_t bytes = blocks.size() * sizeof(FormFactorBlock);
  for (const FormFactorBlock& block : blocks) bytes += block.packed_bytes;
  return bytes;
}

FormFactorMatrix make_form_factors(uint32_t rows, uint32_t columns, std::shared_ptr<SpillFile> spill) {
  FormFactorMatrix form_factors;
  form_factors.spill = std::move(spill);
  form_factors.rows = rows;
  form_factors.columns = columns;
  form_factors.blocks.resize((rows + FormFactorMatrix::kRowsPerBlock - 1) / FormFactorMatrix::kRowsPerBlock);
  return form_factors;
}

void append_row(FormFactorBlock& block, std::span<const FormFactor> row) {
  for (size_t i = 0; i < row.size(); ++i) {
    if (!std::isfinite(row[i].weight))
      throw std::logic_error(
          fmt::format("internal check failed: a weight is {}, expected a finite number", row[i].weight));
    if (i > 0 && row[i].patch <= row[i - 1].patch)
      throw std::logic_error(fmt::format("internal check failed: patch {} follows patch {} in a row",
                                         row[i].patch, row[i - 1].patch));
  }
  if (!block.open) block.open = std::make_unique<OpenRows>();
  block.open->entries.insert(block.open->entries.end(), row.begin(), row.end());
  block.open->ends.push_back(static_cast<uint32_t>(block.open->entries.size()));
}

void finish_block(FormFactorMatrix& form_factors, size_t index) {
  FormFactorBlock& block = form_factors.blocks[index];
  const size_t first = index * FormFactorMatrix::kRowsPerBlock;
  expect_equal(block.open ? block.open->ends.size() : 0,
               std::min<size_t>(FormFactorMatrix::kRowsPerBlock, form_factors.rows - first),
               "rows of a block");
  block = pack_block(*block.open);
  if (!form_factors.spill) return;
  block.spilled = form_factors.spill->store({std::span<const std::byte>(block.packed)});
  block.packed = std::vector<std::byte>();  // `= {}` would keep the memory
}

void finish_blocks(FormFactorMatrix& form_factors) {
  for (size_t b = 0; b < form_factors.blocks.size(); ++b) finish_block(form_factors, b);
}

BlockView view_block(const FormFactorBlock& block) {
  BlockView view{};
  view.rows = block.rows;
  view.base = block.base;
  view.start_shift = block.start_shift;
  view.weight_bits = block.weight_bits;
  view.sum_unit = std::ldexp(1, block.sum_exponent);
  view.rows_as_long = reinterpret_cast<const uint16_t*>(packed_bytes(block));
  view.filled = view.rows_as_long[0];
  view.codes = view.rows_as_long + block.longest + 1;
  view.sum_low = view.codes + block.codes;
  view.sum_high = reinterpret_cast<const uint8_t*>(view.sum_low + view.filled);
  view.row = view.sum_high + view.filled;
  view.start = view.row + view.filled;
  return view;
}

void close_view(const FormFactorBlock& block) {
  if (block.spilled) SpillFile::release(block.spilled, block.packed_bytes);
}

void unpack_block(const FormFactorBlock& block, BlockRows& rows) {
  constexpr uint32_t kNone = 0xffffffff;
  const BlockView view = view_block(block);
  // A row's columns ascend; a multiple may have several codes.
  std::vector<uint32_t> last(view.rows, kNone);
  std::vector<double> quanta(view.rows);
  rows.row_begin.assign(view.rows + 1, 0);
  visit_packed(view, [&](uint32_t row, uint32_t column, uint32_t multiple) {
    quanta[row] += multiple;
    if (last[row] == column) return;
    last[row] = column;
    ++rows.row_begin[row + 1];
  });
  for (uint32_t r = 0; r < view.rows; ++r) rows.row_begin[r + 1] += rows.row_begin[r];
  for (uint32_t place = 0; place < view.filled; ++place)
    quanta[view.row[place]] = view.sum(place) / quanta[view.row[place]];
  rows.columns.assign(rows.row_begin.back(), 0);
  std::vector<double> multiples(rows.columns.size());
  std::vector<uint32_t> end(rows.row_begin.begin(), rows.row_begin.end() - 1);
  visit_packed(view, [&](uint32_t row, uint32_t column, uint32_t multiple) {
    if (end[row] == rows.row_begin[row] || rows.columns[end[row] - 1] != column)
      rows.columns[end[row]++] = column;
    multiples[end[row] - 1] += multiple;
  });
  rows.weights.resize(multiples.size());
  for (uint32_t r = 0; r < view.rows; ++r)
    for (uint32_t i = rows.row_begin[r]; i < rows.row_begin[r + 1]; ++i)
      rows.weights[i] = static_cast<float>(multiples[i] * quanta[r]);
  close_view(block);
}

std::vector<double> row_sums(const FormFactorMatrix& form_factors) {
  std::vector<double> sums(form_factors.rows);
  parallel_for(form_factors.blocks.size(), 1, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      const BlockView view = view_block(form_factors.blocks[b]);
      for (uint32_t place = 0; place < view.filled; ++place)
        sums[b * FormFactorMatrix::kRowsPerBlock + view.row[place]] = view.sum(place);
      close_view(form_factors.blocks[b]);
    }
  });
  return sums;
}

}  // namespace hemibake
