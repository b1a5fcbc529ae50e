#include "transport/links/pack.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <numeric>

namespace hemibake {
namespace {

constexpr double kFinenessPerSum = 300, kLeastFineness = 12, kMostFineness = 64;
// Sum of the multiples of a row with a weight above ½, at least: light leaves a deep pit by small form
// factors.
constexpr double kDominatedFineness = 4096;
constexpr int kMostWeightBits = 10;
constexpr int kSumBits = 24;
constexpr size_t kBytesPerRow = 5;  // its sum, its index, its start

double weight_of(const FormFactor& link) { return std::max(0.0, static_cast<double>(link.weight)); }

// Finds the largest unit of which all weights are whole multiples, within their rounding to float. Returns
// the sum of the multiples, or 0 if there is no such unit. least: the least weight above 0.
uint64_t whole_multiples(std::span<const FormFactor> row, double least, std::span<uint32_t> multiples) {
  // Rounding makes a mean of at most kMostFineness: the least multiple is no larger unless more than half of
  // the entries were rounded to zero.
  constexpr int kMostParts = 2 * static_cast<int>(kMostFineness);
  // Cosines have a common unit too, but far finer than rounding would take.
  const double most_multiple = kMostParts * static_cast<double>(row.size());
  // Weights are rounded to float, and the largest of a row takes the rounding of the others and of E₀.
  const auto is_whole = [](double exact, double per_weight) {
    const double rounded = static_cast<double>(static_cast<int64_t>(exact + 0.5));
    return std::abs(exact - rounded) <= std::clamp(0x1p-23 * per_weight, 1e-4, 1e-2) + 1e-6 * exact;
  };
  // The unit is the least weight over the least common denominator of all weights over it.
  const double per_least = 1 / least;
  int parts = 1;
  for (const FormFactor& link : row) {
    const double over_least = weight_of(link) * per_least;
    if (over_least > most_multiple) return 0;
    int common = parts;
    while (!is_whole(over_least * common, per_least * common))
      if ((common += parts) > kMostParts) return 0;
    parts = common;
  }
  uint64_t total = 0;
  const double per_weight = parts * per_least;
  for (size_t i = 0; i < row.size(); ++i) {
    const double exact = weight_of(row[i]) * per_weight;
    if (exact > most_multiple || !is_whole(exact, per_weight)) return 0;
    multiples[i] = static_cast<uint32_t>(exact + 0.5);
    total += multiples[i];
  }
  return static_cast<double>(total) <= most_multiple ? total : 0;
}

// The part of a multiple that rounding down cuts off.
struct Remainder {
  double left;
  uint32_t index;
};

// Rounds weights to multiples that add up to `total`, by the largest remainders.
void round_multiples(std::span<const FormFactor> row, double quantum, double total,
                     std::span<uint32_t> multiples) {
  thread_local std::vector<Remainder> remainders;  // scratch
  remainders.clear();
  double rounded = 0;
  for (size_t i = 0; i < row.size(); ++i) {
    const double exact = weight_of(row[i]) / quantum;
    multiples[i] = static_cast<uint32_t>(exact);
    rounded += multiples[i];
    remainders.push_back({exact - multiples[i], static_cast<uint32_t>(i)});
  }
  // Ties go to the first.
  const double missing = std::clamp(total - rounded, 0.0, static_cast<double>(row.size()));
  const auto end = remainders.begin() + static_cast<std::ptrdiff_t>(missing);
  if (end != remainders.begin())
    std::nth_element(remainders.begin(), end - 1, remainders.end(),
                     [](const Remainder& a, const Remainder& b) {
                       return a.left != b.left ? a.left > b.left : a.index < b.index;
                     });
  for (auto remainder = remainders.begin(); remainder != end; ++remainder) ++multiples[remainder->index];
}

// Rounds a row's weights to multiples of its quantum. Returns the sum of the weights.
double round_weights(std::span<const FormFactor> row, std::span<uint32_t> multiples) {
  double sum = 0, positive = 0, largest = 0, least = std::numeric_limits<double>::infinity();
  size_t count = 0;
  for (const FormFactor& link : row) {
    const double weight = static_cast<double>(link.weight);
    sum += weight;
    if (weight <= 0) continue;
    positive += weight;
    least = std::min(least, weight);
    largest = std::max(largest, weight);
    ++count;
  }
  if (!(sum > 0)) return 0;
  if (whole_multiples(row, least, multiples) > 0) return sum;
  const double entries = static_cast<double>(count);
  double total = std::ceil(std::clamp(kFinenessPerSum * sum * std::sqrt(entries), kLeastFineness * entries,
                                      kMostFineness * entries));
  if (largest > 0.5) total = std::max(total, kDominatedFineness);
  round_multiples(row, positive / total, total, multiples);
  return sum;
}

// Rows while they are packed.
struct Rows {
  std::vector<uint32_t> multiples;  // of all entries
  std::vector<double> sums;         // of every row
  std::vector<uint32_t> before;     // the column each row's first step leads from
  std::vector<uint8_t> starts;
  std::vector<uint16_t> codes;  // row by row
  std::vector<uint32_t> code_ends;
  std::vector<uint32_t> order;  // row at every place
};

uint32_t begin_of(const std::vector<uint32_t>& ends, size_t row) { return row == 0 ? 0 : ends[row - 1]; }
uint32_t code_count(const Rows& rows, size_t row) {
  return rows.code_ends[row] - begin_of(rows.code_ends, row);
}

void round_rows(const OpenRows& open, FormFactorBlock& block, Rows& rows) {
  rows.multiples.assign(open.entries.size(), 0);
  rows.sums.resize(block.rows);
  double largest = 0;
  for (size_t r = 0; r < block.rows; ++r) {
    const uint32_t begin = begin_of(open.ends, r), count = open.ends[r] - begin;
    rows.sums[r] = round_weights(std::span(open.entries).subspan(begin, count),
                                 std::span(rows.multiples).subspan(begin, count));
    largest = std::max(largest, rows.sums[r]);
  }
  int exponent = 0;
  if (std::frexp(largest, &exponent) == 0.5) --exponent;
  block.sum_exponent = static_cast<int16_t>(exponent - kSumBits);
  for (size_t r = 0; r < block.rows; ++r) {
    rows.sums[r] = std::floor(std::ldexp(rows.sums[r], -block.sum_exponent) + 0.5);
    if (rows.sums[r] == 0)
      std::fill(rows.multiples.begin() + begin_of(open.ends, r), rows.multiples.begin() + open.ends[r], 0);
  }
}

// Sets where rows start: as near before their first columns as 8 bits allow.
void set_starts(const OpenRows& open, FormFactorBlock& block, Rows& rows) {
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t>& first = rows.before;
  first.assign(block.rows, kNone);
  uint32_t lowest = kNone, highest = 0;
  for (size_t r = 0, i = 0; r < block.rows; ++r) {
    const size_t end = open.ends[r];
    while (i < end && rows.multiples[i] == 0) ++i;
    if (i < end) {
      first[r] = open.entries[i].patch;
      lowest = std::min(lowest, first[r]);
      highest = std::max(highest, first[r]);
    }
    i = end;
  }
  rows.starts.assign(block.rows, 0);
  if (lowest == kNone) return;
  block.base = lowest;
  while ((highest - lowest) >> block.start_shift > 255) ++block.start_shift;
  for (size_t r = 0; r < block.rows; ++r) {
    if (first[r] == kNone) continue;
    rows.starts[r] = static_cast<uint8_t>((first[r] - lowest) >> block.start_shift);
    first[r] = lowest + (uint32_t{rows.starts[r]} << block.start_shift) - 1;
  }
}

// Calls visit(step, multiple) for the stored entries of a row.
template <class Visit>
void visit_steps(const OpenRows& open, const Rows& rows, size_t row, const Visit& visit) {
  uint32_t column = rows.before[row];
  for (uint32_t i = begin_of(open.ends, row); i < open.ends[row]; ++i) {
    if (rows.multiples[i] == 0) continue;
    visit(open.entries[i].patch - column, rows.multiples[i]);
    column = open.entries[i].patch;
  }
}

// Estimates the codes that a number takes beyond its first one. number_bits: its width. bits: of it in a
// code.
size_t more_codes(int number_bits, int bits) {
  return number_bits <= bits ? 0 : 1 + ((uint64_t{1} << number_bits) >> (2 * bits));
}

// Chooses the width of weights that takes the fewest codes.
void choose_weight_bits(const OpenRows& open, FormFactorBlock& block, const Rows& rows) {
  std::array<size_t, 33> steps{}, multiples{};  // by their numbers of bits
  for (size_t r = 0; r < block.rows; ++r)
    visit_steps(open, rows, r, [&](uint32_t step, uint32_t multiple) {
      ++steps[static_cast<size_t>(std::bit_width(step))];
      ++multiples[static_cast<size_t>(std::bit_width(multiple))];
    });
  size_t fewest = std::numeric_limits<size_t>::max();
  for (int weight_bits = 1; weight_bits <= kMostWeightBits; ++weight_bits) {
    size_t more = 0;
    for (size_t bits = 0; bits < steps.size(); ++bits)
      more += steps[bits] * more_codes(static_cast<int>(bits), FormFactorBlock::kCodeBits - weight_bits) +
              multiples[bits] * more_codes(static_cast<int>(bits), weight_bits);
    if (more >= fewest) continue;
    fewest = more;
    block.weight_bits = static_cast<uint8_t>(weight_bits);
  }
  block.entries = static_cast<uint32_t>(std::accumulate(multiples.begin(), multiples.end(), size_t{0}));
}

void encode_rows(const OpenRows& open, FormFactorBlock& block, Rows& rows) {
  const int weight_bits = block.weight_bits;
  const uint32_t most_weight = (1u << weight_bits) - 1;
  const uint32_t most_step = (1u << (FormFactorBlock::kCodeBits - weight_bits)) - 1;
  rows.codes.clear();
  rows.code_ends.resize(block.rows);
  const auto emit = [&](uint32_t step, uint32_t weight) {
    rows.codes.push_back(static_cast<uint16_t>(step << weight_bits | weight));
  };
  for (size_t r = 0; r < block.rows; ++r) {
    visit_steps(open, rows, r, [&](uint32_t step, uint32_t multiple) {
      if (step > most_step) {
        uint32_t far = (step - 1) / most_step;
        step -= far * most_step;
        for (; far > most_step; far -= most_step) emit(most_step, 0);
        emit(far, 0);
      }
      uint32_t large = (multiple - 1) / most_weight;
      emit(step, multiple - large * most_weight);
      for (; large > most_weight; large -= most_weight) emit(0, most_weight);
      if (large > 0) emit(0, large);
    });
    rows.code_ends[r] = static_cast<uint32_t>(rows.codes.size());
  }
  block.codes = static_cast<uint32_t>(rows.codes.size());
}

// Orders rows by falling number of codes, without the empty ones.
void sort_rows(FormFactorBlock& block, Rows& rows) {
  rows.order.resize(block.rows);
  std::iota(rows.order.begin(), rows.order.end(), 0u);
  std::ranges::stable_sort(rows.order, std::greater{}, [&](uint32_t row) { return code_count(rows, row); });
  while (!rows.order.empty() && code_count(rows, rows.order.back()) == 0) rows.order.pop_back();
  block.longest = rows.order.empty() ? 0 : code_count(rows, rows.order[0]);
}

template <class Number>
std::byte* write(std::byte* to, Number number) {
  std::memcpy(to, &number, sizeof(Number));
  return to + sizeof(Number);
}

std::byte* write_codes(const Rows& rows, std::byte* to) {
  for (size_t first = 0; first < rows.order.size(); first += FormFactorBlock::kInterleavedRows) {
    std::array<uint32_t, FormFactorBlock::kInterleavedRows> next{}, end{};
    for (uint32_t i = 0; i < FormFactorBlock::kInterleavedRows && first + i < rows.order.size(); ++i) {
      next[i] = begin_of(rows.code_ends, rows.order[first + i]);
      end[i] = rows.code_ends[rows.order[first + i]];
    }
    while (next[0] < end[0])
      for (uint32_t i = 0; i < FormFactorBlock::kInterleavedRows && next[i] < end[i]; ++i)
        to = write(to, rows.codes[next[i]++]);
  }
  return to;
}

// Writes the block in the order of BlockView.
void write_block(FormFactorBlock& block, const Rows& rows) {
  block.packed_bytes = (size_t{block.longest} + 1 + block.codes) * sizeof(uint16_t) +
                       rows.order.size() * kBytesPerRow + FormFactorBlock::kPadding;
  block.packed.resize(block.packed_bytes);
  std::byte* to = block.packed.data();
  uint32_t longer = static_cast<uint32_t>(rows.order.size());
  for (uint32_t k = 0; k <= block.longest; ++k) {
    while (longer > 0 && code_count(rows, rows.order[longer - 1]) <= k) --longer;
    to = write(to, static_cast<uint16_t>(longer));
  }
  to = write_codes(rows, to);
  const auto sum_less_1 = [&](uint32_t row) {
    return static_cast<uint32_t>(std::max(rows.sums[row], 1.0)) - 1;
  };
  for (const uint32_t row : rows.order) to = write(to, static_cast<uint16_t>(sum_less_1(row)));
  for (const uint32_t row : rows.order) to = write(to, static_cast<uint8_t>(sum_less_1(row) >> 16));
  for (const uint32_t row : rows.order) to = write(to, static_cast<uint8_t>(row));
  for (const uint32_t row : rows.order) to = write(to, rows.starts[row]);
}

}  // namespace

FormFactorBlock pack_block(const OpenRows& open) {
  thread_local Rows rows;  // scratch
  FormFactorBlock block;
  block.rows = static_cast<uint32_t>(open.ends.size());
  round_rows(open, block, rows);
  set_starts(open, block, rows);
  choose_weight_bits(open, block, rows);
  encode_rows(open, block, rows);
  sort_rows(block, rows);
  write_block(block, rows);
  return block;
}

}  // namespace hemibake
