#include "transport/links_pack.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

namespace hemibake {
namespace {

constexpr double kFinenessPerSum = 200, kLeastFineness = 12, kMostFineness = 64;
// Multiples of a row that gets over half of all its light by one link: light in a deep pit leaves it by others,
// however small they are.
constexpr double kDominatedFineness = 4096;
constexpr int kFewestWeightBits = 2, kMostWeightBits = 12;

std::span<const Link> open_row(const OpenRows& open, size_t row) {
  const uint32_t begin = row == 0 ? 0 : open.ends[row - 1];
  return std::span(open.links).subspan(begin, open.ends[row] - begin);
}

double weight_of(const Link& link) { return std::max(0.0, static_cast<double>(link.weight)); }

// The smallest whole multiples of one unit that all weights are, within what rounding to float leaves of
// them; their sum, or 0 where there is no such unit.
uint64_t whole_multiples(std::span<const Link> row, double least, std::span<uint32_t> multiples) {
  // Rounding makes a mean of at most kMostFineness: the least multiple is no larger unless more than half of
  // the links were lost to it.
  constexpr int kMostParts = 2 * static_cast<int>(kMostFineness);
  // A finer unit than rounding would take, at the most: with cosines for weights there is one, but far finer.
  const double most_multiple = kMostParts * static_cast<double>(row.size());
  for (int parts = 1; parts <= kMostParts; ++parts) {
    uint64_t total = 0;
    size_t i = 0;
    for (; i < row.size(); ++i) {
      const double exact = weight_of(row[i]) * (parts / least);
      if (exact > most_multiple) break;
      multiples[i] = static_cast<uint32_t>(exact + 0.5);
      if (std::abs(exact - multiples[i]) > 1e-4 + 1e-6 * exact) break;
      total += multiples[i];
    }
    if (i == row.size() && static_cast<double>(total) <= most_multiple) return total;
  }
  return 0;
}

// What rounding a weight down left of its multiple.
struct Remainder {
  double left;
  uint32_t index;
};

// Multiples that add up to `total`, by the largest remainders.
void round_multiples(std::span<const Link> row, double quantum, double total, std::span<uint32_t> multiples) {
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

// Weights as multiples of the quantum returned.
float round_weights(std::span<const Link> row, std::span<uint32_t> multiples) {
  double sum = 0, positive = 0, largest = 0, least = std::numeric_limits<double>::infinity();
  size_t count = 0;
  for (const Link& link : row) {
    const double weight = static_cast<double>(link.weight);
    sum += weight;
    if (weight <= 0) continue;
    positive += weight;
    least = std::min(least, weight);
    largest = std::max(largest, weight);
    ++count;
  }
  std::ranges::fill(multiples, 0);
  if (!(sum > 0)) return 0;
  if (const uint64_t total = whole_multiples(row, least, multiples))
    return static_cast<float>(sum / static_cast<double>(total));
  const double links = static_cast<double>(count);
  double total = std::ceil(
      std::clamp(kFinenessPerSum * sum * std::sqrt(links), kLeastFineness * links, kMostFineness * links));
  if (largest > 0.5) total = std::max(total, kDominatedFineness);
  round_multiples(row, positive / total, total, multiples);
  return static_cast<float>(sum / std::accumulate(multiples.begin(), multiples.end(), 0.0));
}

// Calls emit(code) for the links as packed of one row that starts at `column`.
template <class Emit>
void encode_row(std::span<const Link> row, std::span<const uint32_t> multiples, uint32_t column,
                int weight_bits, const Emit& emit) {
  const uint32_t most_weight = (1u << weight_bits) - 1;
  const uint32_t most_step = (1u << (static_cast<int>(LinkBlock::kLinkBits) - weight_bits)) - 1;
  for (size_t i = 0; i < row.size(); ++i) {
    if (multiples[i] == 0) continue;
    uint32_t step = row[i].patch - column;
    column = row[i].patch;
    for (; step > most_step; step -= most_step) emit(most_step << weight_bits);
    for (uint32_t left = multiples[i]; left > 0; step = 0) {
      const uint32_t weight = std::min(left, most_weight);
      emit(step << weight_bits | weight);
      left -= weight;
    }
  }
}

// Rows on their way into a block.
struct Rows {
  std::vector<uint32_t> multiples;  // of all links
  std::vector<float> quanta;        // of every row
  std::vector<uint8_t> starts;
  std::vector<uint32_t> codes, code_ends;  // links as packed, row by row
  std::vector<uint32_t> order;             // row at every place
};

std::span<uint32_t> multiples_of_row(Rows& rows, const OpenRows& open, size_t row) {
  const uint32_t begin = row == 0 ? 0 : open.ends[row - 1];
  return std::span(rows.multiples).subspan(begin, open.ends[row] - begin);
}

template <class Emit>
void encode_open_row(const LinkBlock& block, const OpenRows& open, Rows& rows, size_t row, int weight_bits,
                     const Emit& emit) {
  encode_row(open_row(open, row), multiples_of_row(rows, open, row),
             block.base + (uint32_t{rows.starts[row]} << block.start_shift), weight_bits, emit);
}

// Where the rows start: as near before their first columns as 8 bits tell.
void set_starts(const OpenRows& open, LinkBlock& block, Rows& rows) {
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> first(block.rows, kNone);
  uint32_t lowest = kNone, highest = 0;
  for (size_t r = 0, i = 0; r < block.rows; ++r) {
    const size_t end = open.ends[r];
    while (i < end && rows.multiples[i] == 0) ++i;
    if (i < end) {
      first[r] = open.links[i].patch;
      lowest = std::min(lowest, first[r]);
      highest = std::max(highest, first[r]);
    }
    i = end;
  }
  block.base = lowest == kNone ? 0 : lowest;
  block.start_shift = 0;
  while (lowest != kNone && (highest - lowest) >> block.start_shift > 255) ++block.start_shift;
  rows.starts.assign(block.rows, 0);
  for (size_t r = 0; r < block.rows; ++r)
    if (first[r] != kNone)
      rows.starts[r] = static_cast<uint8_t>((first[r] - block.base) >> block.start_shift);
}

// The width of weights that takes the fewest links.
void choose_weight_bits(const OpenRows& open, LinkBlock& block, Rows& rows) {
  size_t fewest = std::numeric_limits<size_t>::max();
  for (int bits = kFewestWeightBits; bits <= kMostWeightBits; ++bits) {
    size_t count = 0;
    for (size_t r = 0; r < block.rows; ++r)
      encode_open_row(block, open, rows, r, bits, [&](uint32_t) { ++count; });
    if (count >= fewest) continue;
    fewest = count;
    block.weight_bits = static_cast<uint8_t>(bits);
  }
}

void encode_rows(const OpenRows& open, const LinkBlock& block, Rows& rows) {
  rows.codes.clear();
  rows.code_ends.clear();
  for (size_t r = 0; r < block.rows; ++r) {
    encode_open_row(block, open, rows, r, block.weight_bits,
                    [&](uint32_t code) { rows.codes.push_back(code); });
    rows.code_ends.push_back(static_cast<uint32_t>(rows.codes.size()));
  }
}

uint32_t code_begin(const Rows& rows, uint32_t row) { return row == 0 ? 0 : rows.code_ends[row - 1]; }
uint32_t code_count(const Rows& rows, uint32_t row) { return rows.code_ends[row] - code_begin(rows, row); }

// Appends bytes of numbers to the packed block.
class Writer {
 public:
  explicit Writer(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <class Number>
  void append(Number number) {
    const auto* from = reinterpret_cast<const std::byte*>(&number);
    bytes_.insert(bytes_.end(), from, from + sizeof(Number));
  }

 private:
  std::vector<std::byte>& bytes_;
};

// Different quanta where an index is shorter; empty where it is not.
std::vector<float> quantum_table(const std::vector<float>& quanta) {
  std::vector<float> table = quanta;
  std::ranges::sort(table);
  const auto repeated = std::ranges::unique(table);
  table.erase(repeated.begin(), repeated.end());
  if (table.size() * sizeof(float) + quanta.size() >= quanta.size() * sizeof(float)) table.clear();
  return table;
}

void write_links(const LinkBlock& block, const Rows& rows, Writer& writer) {
  std::vector<uint32_t> turn;
  for (uint32_t first = 0; first < block.rows; first += LinkBlock::kRowsInTurn) {
    const uint32_t end = std::min(block.rows, first + LinkBlock::kRowsInTurn);
    for (uint32_t k = 0; k < code_count(rows, rows.order[first]); ++k) {
      turn.clear();
      for (uint32_t place = first; place < end && code_count(rows, rows.order[place]) > k; ++place)
        turn.push_back(rows.codes[code_begin(rows, rows.order[place]) + k]);
      for (const uint32_t code : turn) writer.append(static_cast<uint16_t>(code));
      for (const uint32_t code : turn) writer.append(static_cast<uint8_t>(code >> 16));
    }
  }
}

void write_block(LinkBlock& block, const Rows& rows) {
  const std::vector<float> table = quantum_table(rows.quanta);
  block.quanta = static_cast<uint32_t>(table.empty() ? block.rows : table.size());
  block.longest = block.rows == 0 ? 0 : code_count(rows, rows.order[0]);
  block.packed.clear();
  Writer writer(block.packed);
  if (table.empty()) {
    for (const uint32_t row : rows.order) writer.append(rows.quanta[row]);
  } else {
    for (const float quantum : table) writer.append(quantum);
  }
  auto longer = static_cast<uint16_t>(block.rows);
  for (uint32_t k = 0; k <= block.longest; ++k) {
    while (longer > 0 && code_count(rows, rows.order[longer - 1u]) <= k) --longer;
    writer.append(longer);
  }
  for (const uint32_t row : rows.order) writer.append(static_cast<uint8_t>(row));
  for (const uint32_t row : rows.order) writer.append(rows.starts[row]);
  if (!table.empty())
    for (const uint32_t row : rows.order)
      writer.append(static_cast<uint8_t>(std::ranges::lower_bound(table, rows.quanta[row]) - table.begin()));
  write_links(block, rows, writer);
  block.packed.resize(block.packed.size() + LinkBlock::kPadding);
  block.packed.shrink_to_fit();
  block.packed_bytes = block.packed.size();
}

}  // namespace

LinkBlock pack_block(const OpenRows& open) {
  thread_local Rows rows;  // scratch
  LinkBlock block;
  block.rows = static_cast<uint32_t>(open.ends.size());
  rows.multiples.assign(open.links.size(), 0);
  rows.quanta.clear();
  for (size_t r = 0; r < block.rows; ++r)
    rows.quanta.push_back(round_weights(open_row(open, r), multiples_of_row(rows, open, r)));
  block.links =
      static_cast<uint32_t>(std::ranges::count_if(rows.multiples, [](uint32_t k) { return k > 0; }));
  set_starts(open, block, rows);
  choose_weight_bits(open, block, rows);
  encode_rows(open, block, rows);
  rows.order.resize(block.rows);
  std::iota(rows.order.begin(), rows.order.end(), 0u);
  std::ranges::stable_sort(rows.order, std::greater{}, [](uint32_t row) { return code_count(rows, row); });
  write_block(block, rows);
  return block;
}

}  // namespace hemibake
