#include "transport/links.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "transport/spill_file.h"

namespace hemibake {
namespace {

constexpr uint32_t kGroup = LinkBlock::kColumnsPerGroup;
constexpr uint32_t kLargestStep = 255;
constexpr double kLargestMultiple = 65535;
constexpr int kQuantumBits = 16;  // of a double left out of PackedRow::quantum

// Down to the upper 48 bits.
double round_quantum(double quantum) {
  return std::bit_cast<double>(std::bit_cast<uint64_t>(quantum) >> kQuantumBits << kQuantumBits);
}

std::array<uint16_t, 3> pack_quantum(double quantum) {
  const uint64_t bits = std::bit_cast<uint64_t>(quantum) >> kQuantumBits;
  return {static_cast<uint16_t>(bits), static_cast<uint16_t>(bits >> 16), static_cast<uint16_t>(bits >> 32)};
}

// Calls visit(row in the block, patch, multiple of the row's quantum) for every link.
template <class Visit>
void visit_links(const LinkBlock& block, const Visit& visit) {
  const BlockView view = view_block(block);
  const uint16_t* code = view.codes;
  const uint16_t* weight = view.weights;
  for (size_t row = 0; row < view.rows.size(); ++row) {
    uint32_t group = first_group(view.rows[row], view.anchor);
    for (; *code != 0; ++code) {
      group += static_cast<uint32_t>(groups_ahead(*code));
      for (uint32_t columns = *code >> 8; columns != 0; columns &= columns - 1)
        visit(row, group * kGroup + static_cast<uint32_t>(std::countr_zero(columns)), *weight++);
    }
    ++code;
  }
}

template <class Number>
std::span<const std::byte> bytes_of(const std::vector<Number>& values) {
  return std::as_bytes(std::span(values));
}

// What rounding a weight down left of its multiple.
struct Remainder {
  double left;
  uint32_t index;
};

// Weights as multiples of a quantum, which is returned; their sum is kept (largest remainders).
double round_weights(std::span<const Link> row, std::vector<uint16_t>& multiples) {
  thread_local std::vector<Remainder> remainders;  // scratch
  multiples.assign(row.size(), 0);
  double sum = 0, largest = 0;
  for (size_t i = 0; i < row.size(); ++i) {
    const double weight = static_cast<double>(row[i].weight);
    if (!std::isfinite(weight))
      throw std::logic_error(
          fmt::format("internal check failed: a weight is {}, expected a finite number", weight));
    if (i > 0 && row[i].patch <= row[i - 1].patch)
      throw std::logic_error(fmt::format("internal check failed: patch {} follows patch {} in a row",
                                         row[i].patch, row[i - 1].patch));
    sum += weight;
    largest = std::max(largest, weight);
  }
  // A largest weight that is almost all there is may round to a multiple too many.
  constexpr double kSlack = 1e-3;
  const double total = sum > 0 ? std::floor(sum / largest * kLargestMultiple + kSlack) : 0;
  if (total < 1) return 0;
  const double quantum = sum / total;
  remainders.clear();
  double rounded = 0;
  for (size_t i = 0; i < row.size(); ++i) {
    const double exact = std::clamp(static_cast<double>(row[i].weight) / quantum, 0.0, kLargestMultiple),
                 down = std::floor(exact);
    multiples[i] = static_cast<uint16_t>(down);
    rounded += down;
    if (down < kLargestMultiple) remainders.push_back({exact - down, static_cast<uint32_t>(i)});
  }
  // Ties go to the first. Negative weights, counted as 0, can have left too much instead of too little.
  const double missing = std::clamp(total - rounded, 0.0, static_cast<double>(remainders.size()));
  const auto end = remainders.begin() + static_cast<std::ptrdiff_t>(missing);
  if (end != remainders.begin())
    std::nth_element(remainders.begin(), end - 1, remainders.end(),
                     [](const Remainder& a, const Remainder& b) {
                       return a.left != b.left ? a.left > b.left : a.index < b.index;
                     });
  for (auto remainder = remainders.begin(); remainder != end; ++remainder) ++multiples[remainder->index];
  return round_quantum(sum / (rounded + missing));
}

uint16_t make_code(uint32_t step, uint32_t columns) { return static_cast<uint16_t>(columns << 8 | step); }

// Codes that lead `steps` groups on, all but the last one's part.
uint32_t append_far_steps(uint32_t steps, std::vector<uint16_t>& codes) {
  while (steps > kLargestStep) {
    const uint32_t far = std::min(kLargestStep, steps >> 8);
    codes.push_back(make_code(far, 0));
    steps -= far << 8;
  }
  return steps;
}

int16_t start_before(uint32_t group, uint32_t anchor) {
  const int64_t distance = int64_t{group} - int64_t{anchor};
  constexpr int64_t kFarthest = std::numeric_limits<int16_t>::max();
  return distance < -kFarthest ? std::numeric_limits<int16_t>::min()
                               : static_cast<int16_t>(std::min(distance, kFarthest));
}

}  // namespace

uint64_t Links::count() const {
  uint64_t links = 0;
  for (const LinkBlock& block : blocks) links += block.link_count();
  return links;
}

size_t Links::stored_bytes() const {
  size_t bytes = blocks.size() * sizeof(LinkBlock);
  for (const LinkBlock& block : blocks) bytes += hemibake::stored_bytes(block);
  return bytes;
}

Links make_links(uint32_t rows, uint32_t columns, std::shared_ptr<SpillFile> spill) {
  Links links;
  links.spill = std::move(spill);
  links.rows = rows;
  links.columns = columns;
  links.blocks.resize((rows + Links::kRowsPerBlock - 1) / Links::kRowsPerBlock);
  // Rows see what lies about them, and rows and columns run over the map alike.
  for (size_t b = 0; b < links.blocks.size(); ++b)
    links.blocks[b].anchor =
        static_cast<uint32_t>(uint64_t{b} * Links::kRowsPerBlock * columns / rows / kGroup);
  return links;
}

void append_row(LinkBlock& block, std::span<const Link> row) {
  thread_local std::vector<uint16_t> multiples;  // scratch
  const double quantum = round_weights(row, multiples);
  size_t first = 0;
  while (first < row.size() && multiples[first] == 0) ++first;
  PackedRow packed{pack_quantum(quantum), 0};
  block.weights.resize(block.link_count());
  if (first < row.size()) {
    packed.start = start_before(row[first].patch / kGroup, block.anchor);
    uint32_t at = first_group(packed, block.anchor);
    for (size_t i = first; i < row.size();) {
      const uint32_t group = row[i].patch / kGroup;
      uint32_t columns = 0;
      for (; i < row.size() && row[i].patch / kGroup == group; ++i) {
        if (multiples[i] == 0) continue;
        columns |= 1u << row[i].patch % kGroup;
        block.weights.push_back(multiples[i]);
      }
      if (columns == 0) continue;
      block.codes.push_back(make_code(append_far_steps(group - at, block.codes), columns));
      at = group;
    }
  }
  block.codes.push_back(0);
  block.weights.resize(block.weights.size() + kGroup - 1);
  block.rows.push_back(packed);
}

size_t stored_bytes(const LinkBlock& block) {
  const LinkBlock::Spilled& spilled = block.spilled;
  if (spilled.bytes)
    return spilled.rows * sizeof(PackedRow) + (spilled.codes + spilled.weights) * sizeof(uint16_t);
  return bytes_of(block.rows).size() + bytes_of(block.codes).size() + bytes_of(block.weights).size();
}

void finish_block(Links& links, size_t index) {
  LinkBlock& block = links.blocks[index];
  if (!links.spill) {
    block.rows.shrink_to_fit();
    block.codes.shrink_to_fit();
    block.weights.shrink_to_fit();
    return;
  }
  const std::byte* bytes =
      links.spill->store({bytes_of(block.rows), bytes_of(block.codes), bytes_of(block.weights)});
  block.spilled = {bytes, block.rows.size(), block.codes.size(), block.weights.size()};
  block.rows = {};
  block.codes = {};
  block.weights = {};
}

BlockView view_block(const LinkBlock& block) {
  const LinkBlock::Spilled& spilled = block.spilled;
  if (!spilled.bytes) return {block.anchor, block.rows, block.codes.data(), block.weights.data()};
  const auto* rows = reinterpret_cast<const PackedRow*>(spilled.bytes);
  const auto* codes = reinterpret_cast<const uint16_t*>(rows + spilled.rows);
  return {block.anchor, {rows, spilled.rows}, codes, codes + spilled.codes};
}

void close_view(const LinkBlock& block) {
  if (block.spilled.bytes) SpillFile::release(block.spilled.bytes, stored_bytes(block));
}

void unpack_block(const LinkBlock& block, BlockRows& rows) {
  const BlockView view = view_block(block);
  rows.row_begin.assign(view.rows.size() + 1, 0);
  rows.patches.clear();
  rows.weights.clear();
  visit_links(block, [&](size_t row, uint32_t patch, uint16_t multiple) {
    rows.patches.push_back(patch);
    rows.weights.push_back(static_cast<float>(multiple * quantum_of(view.rows[row])));
    ++rows.row_begin[row + 1];
  });
  std::partial_sum(rows.row_begin.begin(), rows.row_begin.end(), rows.row_begin.begin());
  close_view(block);
}

std::vector<double> row_sums(const Links& links) {
  std::vector<double> sums(links.rows);
  parallel_for(links.blocks.size(), 1, [&](size_t first, size_t last) {
    for (size_t b = first; b < last; ++b) {
      const LinkBlock& block = links.blocks[b];
      double* const of_block = sums.data() + b * Links::kRowsPerBlock;
      visit_links(block, [&](size_t row, uint32_t, uint16_t multiple) { of_block[row] += multiple; });
      const BlockView view = view_block(block);
      for (size_t row = 0; row < view.rows.size(); ++row) of_block[row] *= quantum_of(view.rows[row]);
      close_view(block);
    }
  });
  return sums;
}

}  // namespace hemibake
