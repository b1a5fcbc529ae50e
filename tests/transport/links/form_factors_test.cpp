#include "transport/links/form_factors.h"

#include <gmock/gmock.h>
#include <hwy/targets.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>
#include <stdexcept>

#include "core/error.h"
#include "core/parallel.h"
#include "io/io_testing.h"
#include "transport/links/spill_file.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

// Row i links to i+1 with ¼ and to the row before the last with ½.
FormFactorMatrix ring(uint32_t rows) {
  FormFactorMatrix form_factors = make_form_factors(rows, rows + 1);
  for (uint32_t i = 0; i < rows; ++i) {
    const uint32_t next = (i + 1) % rows;
    append_row(form_factors.blocks[i / FormFactorMatrix::kRowsPerBlock],
               std::vector<FormFactor>{{next, 0.25f}, {rows, 0.5f}});
  }
  finish_blocks(form_factors);
  return form_factors;
}

// Up to 40 links, neighbours and far ones, weights over twelve orders of magnitude.
std::vector<FormFactor> random_row(uint32_t columns, std::mt19937& random) {
  std::vector<FormFactor> row;
  const uint32_t form_factors = random() % 41, reach = random() % 3 == 0 ? 2 : columns / 20 + 1;
  uint32_t patch = random() % columns;
  for (uint32_t i = 0; i < form_factors && patch < columns; ++i) {
    row.push_back({patch, std::pow(10.0f, -static_cast<float>(random() % 12000) / 1000)});
    patch += 1 + random() % reach;
  }
  return row;
}

// One row among others, far into a matrix of `columns`, unpacked again.
std::vector<FormFactor> pack_and_unpack(const std::vector<FormFactor>& row, uint32_t columns,
                                        uint32_t rows = 3) {
  FormFactorMatrix form_factors = make_form_factors(rows, columns);
  for (uint32_t i = 0; i < rows; ++i)
    append_row(form_factors.blocks[i / FormFactorMatrix::kRowsPerBlock],
               i == rows - 2 ? row : std::vector<FormFactor>{{columns - 1, 0.5f}});
  finish_blocks(form_factors);
  BlockRows stored;
  unpack_block(form_factors.blocks.back(), stored);
  const uint32_t at = (rows - 2) % FormFactorMatrix::kRowsPerBlock;
  std::vector<FormFactor> unpacked;
  for (uint32_t k = stored.row_begin[at]; k < stored.row_begin[at + 1]; ++k)
    unpacked.push_back({stored.columns[k], stored.weights[k]});
  // Its neighbours must not have suffered.
  EXPECT_EQ(stored.columns.back(), columns - 1);
  EXPECT_EQ(stored.weights.back(), 0.5f);
  EXPECT_EQ(stored.row_begin[at + 2], stored.row_begin[at + 1] + 1);
  return unpacked;
}

// Half of the last bit that sums have in a block whose other rows add up to ½.
double half_bit_of_sums(double sum) { return std::exp2(std::ceil(std::log2(std::max(sum, 0.5))) - 25); }

// Sum kept, no weight off by a quantum, order and patches kept.
void expect_packed_well(const std::vector<FormFactor>& row, const std::vector<FormFactor>& packed) {
  double sum = 0, packed_sum = 0, positive = 0;
  for (const FormFactor& link : row) {
    sum += static_cast<double>(link.weight);
    positive += link.weight > 0;
  }
  // The quantum is at most a twelfth of the mean weight (see links.h), but for the rounding of the sum.
  const double quantum = sum / (12 * positive) * (1 + 1e-6) + half_bit_of_sums(sum);
  size_t at = 0;
  for (const FormFactor& link : row) {
    const bool kept = at < packed.size() && packed[at].patch == link.patch;
    const double weight = kept ? static_cast<double>(packed[at++].weight) : 0;
    ASSERT_NEAR(weight, static_cast<double>(link.weight), quantum) << link.patch;
    packed_sum += weight;
  }
  EXPECT_EQ(at, packed.size());
  // Every weight is rounded to float.
  EXPECT_NEAR(packed_sum, sum, half_bit_of_sums(sum) + sum * 6e-8);
}

TEST(FormFactorMatrix, GatherIsTheMatrixProduct) {
  const uint32_t rows = 3 * FormFactorMatrix::kRowsPerBlock + 17;
  const FormFactorMatrix form_factors = ring(rows);
  EXPECT_EQ(form_factors.count(), 2u * rows);
  std::vector<double> values(rows + 1), out(rows);
  for (uint32_t i = 0; i <= rows; ++i) values[i] = i + 1;
  multiply(form_factors, values, out);
  // ½ is twice ¼, and the values are whole numbers: nothing is rounded.
  for (uint32_t i = 0; i < rows; ++i) ASSERT_EQ(out[i], 0.25 * ((i + 1) % rows + 1) + 0.5 * (rows + 1));
  for (const double sum : row_sums(form_factors)) ASSERT_EQ(sum, 0.75);
}

// The same numbers whatever the vectors: the product against the rows as unpacked.
TEST(FormFactorMatrix, GatherAgreesWithTheUnpackedRows) {
  std::mt19937 random(5);
  for (const uint32_t columns : {1u, 7u, 8u, 1000u, 3000000u}) {
    FormFactorMatrix form_factors = make_form_factors(2100, columns);
    for (uint32_t i = 0; i < form_factors.rows; ++i)
      append_row(form_factors.blocks[i / FormFactorMatrix::kRowsPerBlock], random_row(columns, random));
    finish_blocks(form_factors);
    std::vector<double> values(columns), out(form_factors.rows);
    for (double& value : values) value = static_cast<double>(random() % 1000);
    multiply(form_factors, values, out);
    // Products are exact in double and added in the order of the links.
    const int64_t all = hwy::SupportedTargets();
    for (int64_t left = all; left != 0; left &= left - 1) {
      hwy::SetSupportedTargetsForTest(left & -left);
      std::vector<double> again(form_factors.rows);
      multiply(form_factors, values, again);
      EXPECT_EQ(again, out) << hwy::TargetName(left & -left);
    }
    hwy::SetSupportedTargetsForTest(0);
    const std::vector<double> sums = row_sums(form_factors);
    BlockRows rows;
    for (uint32_t i = 0; i < form_factors.rows; ++i) {
      if (i % FormFactorMatrix::kRowsPerBlock == 0)
        unpack_block(form_factors.blocks[i / FormFactorMatrix::kRowsPerBlock], rows);
      double product = 0, sum = 0;
      for (uint32_t k = rows.row_begin[i % FormFactorMatrix::kRowsPerBlock];
           k < rows.row_begin[i % FormFactorMatrix::kRowsPerBlock + 1]; ++k) {
        product += static_cast<double>(rows.weights[k]) * values[rows.columns[k]];
        sum += static_cast<double>(rows.weights[k]);
      }
      // Unpacked weights are floats.
      ASSERT_NEAR(out[i], product, 6e-8 * product) << columns;
      ASSERT_NEAR(sums[i], sum, 6e-8 * sum) << columns;
    }
  }
}

TEST(FormFactorMatrix, PackingKeepsTheSumAndMissesNoWeightByAQuantum) {
  std::mt19937 random(1);
  for (const uint32_t columns : {1u, 2u, 9u, 300u, 70000u, 100000000u, 2147483648u})
    for (int i = 0; i < 50; ++i) {
      const std::vector<FormFactor> row = random_row(columns, random);
      expect_packed_well(row, pack_and_unpack(row, columns));
    }
}

TEST(FormFactorMatrix, ExtremeRows) {
  constexpr uint32_t kLast = (1u << 31) - 1;
  const std::vector<std::vector<FormFactor>> rows = {
      {{5, 2.0f}},                                   // the march's published weights
      {{0, 1e-30f}, {kLast, 1e-30f}},                // next to nothing, from end to end
      {{0, 1.0f}, {1, 1e-9f}, {9, 1e-9f}},           // links far below the quantum
      {{3, 0.1f}, {4, 0.1f}, {5, 0.1f}, {6, 0.1f}},  // ties
      {{1u << 24, 0.25f}, {(1u << 24) + 1, 0.5f}, {kLast, 0.125f}},
      {{kLast, 1.0f}}};
  for (const std::vector<FormFactor>& row : rows) expect_packed_well(row, pack_and_unpack(row, 1u << 31));
  // Many that round to nothing by themselves keep their sum together.
  std::vector<FormFactor> dust{{0, 1.0f}};
  for (uint32_t i = 1; i < 5000; ++i) dust.push_back({3 * i, 4e-6f});
  expect_packed_well(dust, pack_and_unpack(dust, 20000));
  // A whole row of all columns.
  std::vector<FormFactor> full(20000);
  for (uint32_t i = 0; i < full.size(); ++i) full[i] = {i, 1.0f / static_cast<float>(1 + i)};
  expect_packed_well(full, pack_and_unpack(full, 20000));
  // A matrix far from square, and its last rows.
  const std::vector<FormFactor> steps{{0, 0.25f}, {2000000000, 0.5f}};
  expect_packed_well(steps, pack_and_unpack(steps, 1u << 31, 5000));
  expect_packed_well({{0, 1.0f}}, pack_and_unpack({{0, 1.0f}}, 1, 5000));
}

// Every length of step and every multiple, at every share of a code that steps and multiples get.
TEST(FormFactorMatrix, StepsAndMultiplesStayExact) {
  for (const uint32_t most_multiple : {1u, 3u, 8u, 40u, 127u})
    for (const uint32_t usual_step : {1u, 200u, 5000u, 300000u}) {
      std::vector<FormFactor> row;
      std::vector<uint32_t> multiples;
      uint32_t patch = 0;
      const auto add = [&](uint32_t step) {
        patch += step;
        multiples.push_back(1 + static_cast<uint32_t>(row.size() * 7) % most_multiple);
        row.push_back({patch, std::ldexp(static_cast<float>(multiples.back()), -17)});
      };
      for (uint32_t power = 0; power < 28; ++power)
        for (const uint32_t step : {(1u << power) - 1, 1u << power, (1u << power) + 1})
          if (step > 0) add(step);
      for (int i = 0; i < 200; ++i) add(usual_step);
      const std::vector<FormFactor> packed = pack_and_unpack(row, 1u << 31);
      ASSERT_EQ(packed.size(), row.size());
      for (size_t i = 0; i < row.size(); ++i) {
        ASSERT_EQ(packed[i].patch, row[i].patch);
        ASSERT_EQ(packed[i].weight, row[i].weight) << most_multiple << ' ' << usual_step;
      }
    }
}

// Eighths of hits that weigh alike, one of them with what rounding left of the row.
TEST(FormFactorMatrix, HitsThatWeighAlikeStayWhole) {
  for (const double hits : {5.0, 37.0, 256.0, 4096.0}) {
    std::vector<FormFactor> row;
    std::vector<double> eighths;
    for (uint32_t i = 0; i < 12; ++i) {
      eighths.push_back(i % 3 == 0 ? 1 + i % 8 : 8 * (1 + i % 4));
      row.push_back({1 + 77 * i * i, static_cast<float>(eighths.back() / (8 * hits))});
    }
    row[7].weight += 6e-8f;
    const std::vector<FormFactor> packed = pack_and_unpack(row, 20000);
    ASSERT_EQ(packed.size(), row.size());
    const double quantum = static_cast<double>(packed[0].weight) / eighths[0];
    for (size_t i = 0; i < row.size(); ++i)
      EXPECT_NEAR(static_cast<double>(packed[i].weight), eighths[i] * quantum, 1.2e-7 * eighths[i] * quantum);
    EXPECT_NEAR(quantum * 8 * hits, 1, 1e-6 + 1e-7 * hits);
  }
}

// Sums that are multiples of their last bit, up to 1 and to 2 itself.
TEST(FormFactorMatrix, SumsAreExact) {
  for (const double scale : {1.0, 2.0, 0x1p-40}) {
    FormFactorMatrix form_factors = make_form_factors(5, 100);
    const std::vector<double> sums{scale, scale * 0x1p-24, 0, scale * 0.75, scale * (1 - 0x1p-24)};
    for (const double sum : sums)
      append_row(form_factors.blocks[0], std::vector<FormFactor>{{7, static_cast<float>(sum / 2)},
                                                                 {8, static_cast<float>(sum - sum / 2)}});
    finish_blocks(form_factors);
    EXPECT_EQ(row_sums(form_factors), sums);
    std::vector<double> out(5);
    multiply(form_factors, std::vector<double>(100, 1), out);
    EXPECT_EQ(out, sums);
  }
}

// What merging leaves of a row that is sky but for rounding.
TEST(FormFactorMatrix, RowsWithoutASumStoreNothing) {
  EXPECT_TRUE(pack_and_unpack({{7, -1e-8f}}, 100).empty());
  EXPECT_TRUE(pack_and_unpack({{7, 0.0f}, {9, 0.0f}}, 100).empty());
  expect_packed_well({{9, 0.5f}}, pack_and_unpack({{7, -1e-9f}, {9, 0.5f}}, 100));
}

// In a deep pit: what little leads out of it counts.
TEST(FormFactorMatrix, SmallLinksBesideAVeryLargeOneStay) {
  const std::vector<FormFactor> row{{1, 0.9931f}, {2, 0.0011f}, {5, 0.0017f}};
  const std::vector<FormFactor> packed = pack_and_unpack(row, 100);
  ASSERT_EQ(packed.size(), row.size());
  // A quantum is less than 1/4096 of their sum.
  for (size_t i = 0; i < row.size(); ++i) EXPECT_NEAR(packed[i].weight, row[i].weight, 1.0f / 4096);
}

TEST(FormFactorMatrix, WhatIsNoRowIsABug) {
  FormFactorMatrix form_factors = make_form_factors(5, 100);
  const auto append = [&](const std::vector<FormFactor>& row) { append_row(form_factors.blocks[0], row); };
  EXPECT_THROW(append({{1, std::nanf("")}}), std::logic_error);
  EXPECT_THROW(append({{1, INFINITY}}), std::logic_error);
  EXPECT_THROW(append({{2, 0.5f}, {1, 0.25f}}), std::logic_error);
  EXPECT_THROW(append({{2, 0.5f}, {2, 0.25f}}), std::logic_error);
}

TEST(FormFactorMatrix, SpilledBlocksReadAsThoseInMemory) {
  const TemporaryFolder folder;
  std::mt19937 random(9);
  FormFactorMatrix kept = make_form_factors(3000, 50000);
  FormFactorMatrix spilled = make_form_factors(3000, 50000, std::make_shared<SpillFile>(folder / ""));
  EXPECT_EQ(folder.count(), 0u);  // it has no name
  for (uint32_t i = 0; i < kept.rows; ++i) {
    const std::vector<FormFactor> row = random_row(kept.columns, random);
    for (FormFactorMatrix* form_factors : {&kept, &spilled})
      append_row(form_factors->blocks[i / FormFactorMatrix::kRowsPerBlock], row);
  }
  for (size_t block = kept.blocks.size(); block-- > 0;)
    for (FormFactorMatrix* form_factors : {&kept, &spilled}) finish_block(*form_factors, block);
  EXPECT_EQ(spilled.count(), kept.count());
  EXPECT_EQ(spilled.stored_bytes(), kept.stored_bytes());
  EXPECT_EQ(spilled.blocks[0].packed.capacity(), 0u);
  EXPECT_EQ(row_sums(spilled), row_sums(kept));
  std::vector<double> values(kept.columns), from_kept(kept.rows), from_spilled(kept.rows);
  for (double& value : values) value = static_cast<double>(random() % 1000);
  multiply(kept, values, from_kept);
  for (int repeat = 0; repeat < 2; ++repeat) {
    multiply(spilled, values, from_spilled);
    EXPECT_EQ(from_spilled, from_kept);
  }
}

// What is mapped of files, bytes.
size_t mapped_file_bytes() {
  std::ifstream statm("/proc/self/statm");
  size_t size = 0, resident = 0, of_files = 0;
  statm >> size >> resident >> of_files;
  return of_files * static_cast<size_t>(sysconf(_SC_PAGE_SIZE));
}

TEST(FormFactorMatrix, SpilledBlocksDoNotStayInMemory) {
  const TemporaryFolder folder;
  std::mt19937 random(4);
  FormFactorMatrix form_factors = make_form_factors(40000, 40000, std::make_shared<SpillFile>(folder / ""));
  for (uint32_t i = 0; i < form_factors.rows; ++i)
    append_row(form_factors.blocks[i / FormFactorMatrix::kRowsPerBlock],
               random_row(form_factors.columns, random));
  finish_blocks(form_factors);
  const std::vector<double> values(form_factors.columns, 1);
  std::vector<double> out(form_factors.rows);
  // The program's own pages are files too: all that runs below has run once on links that lie in memory.
  FormFactorMatrix warm = make_form_factors(form_factors.rows, form_factors.columns);
  for (uint32_t i = 0; i < warm.rows; ++i)
    append_row(warm.blocks[i / FormFactorMatrix::kRowsPerBlock], std::vector<FormFactor>{{i, 1.0f}});
  finish_blocks(warm);
  multiply(warm, values, out);
  row_sums(warm);
  const size_t before = mapped_file_bytes();
  multiply(form_factors, values, out);
  row_sums(form_factors);
  // At the end of a pass some threads hold 64 KiB on either side of their last block.
  EXPECT_LT(mapped_file_bytes(), before + form_factors.stored_bytes() / 4);
}

TEST(FormFactorMatrix, NoRoomToSpillIsOneLine) {
  EXPECT_THAT(error_of<InputError>([] { SpillFile("/nowhere/at/all"); }),
              HasSubstr("/nowhere/at/all: could not make a temporary file for links: No such file"));
  const SmallDisk disk;
  if (!disk.mounted()) GTEST_SKIP() << "may not mount a disk";
  FormFactorMatrix form_factors =
      make_form_factors(FormFactorMatrix::kRowsPerBlock, 10000, std::make_shared<SpillFile>(disk / ""));
  std::vector<FormFactor> row(10000);
  for (uint32_t i = 0; i < row.size(); ++i) row[i] = {i, 0.5f};
  for (uint32_t i = 0; i < form_factors.rows; ++i) append_row(form_factors.blocks[0], row);
  EXPECT_THAT(error_of<InputError>([&] { finish_block(form_factors, 0); }),
              HasSubstr("could not write a temporary file for links: No space left on device"));
  EXPECT_EQ(disk.count(), 0u);
}

// Rows as a rough map has them: runs of neighbours on many rows of the map.
TEST(FormFactorMatrix, ThreeAndAHalfBytesEach) {
  constexpr uint32_t kMapRow = 720, kRows = 2048;
  std::mt19937 random(3);
  FormFactorMatrix form_factors = make_form_factors(kRows, kMapRow * 360);
  for (uint32_t i = 0; i < kRows; ++i) {
    std::vector<FormFactor> row;
    for (uint32_t patch = 1000; patch < 21000; patch += 2 + random() % 10 + (random() % 4 == 0) * kMapRow)
      for (uint32_t run = 1 + random() % 4; run > 0; --run)
        row.push_back({patch++, static_cast<float>(1 + random() % 1000)});
    append_row(form_factors.blocks[i / FormFactorMatrix::kRowsPerBlock], row);
  }
  finish_blocks(form_factors);
  EXPECT_LT(static_cast<double>(form_factors.stored_bytes()) / static_cast<double>(form_factors.count()),
            3.5);
}

TEST(FormFactorMatrix, WrongLengthsAreABug) {
  const FormFactorMatrix form_factors = ring(8);
  std::vector<double> values(7), out(8);
  EXPECT_THROW(multiply(form_factors, values, out), std::logic_error);
}

// Of a wide plain hardly a row has links.
TEST(FormFactorMatrix, EmptyRowsTakeNoMemory) {
  FormFactorMatrix form_factors = make_form_factors(FormFactorMatrix::kRowsPerBlock, 9);
  for (uint32_t i = 0; i < FormFactorMatrix::kRowsPerBlock; ++i)
    append_row(form_factors.blocks[0],
               i == 77 ? std::vector<FormFactor>{{8, 0.5f}} : std::vector<FormFactor>{});
  finish_blocks(form_factors);
  EXPECT_LT(form_factors.stored_bytes(), sizeof(FormFactorBlock) + FormFactorBlock::kPadding + 16);
  std::vector<double> out(FormFactorMatrix::kRowsPerBlock, NAN);
  multiply(form_factors, std::vector<double>(9, 1.0), out);
  for (uint32_t i = 0; i < FormFactorMatrix::kRowsPerBlock; ++i) EXPECT_EQ(out[i], i == 77 ? 0.5 : 0) << i;
}

TEST(FormFactorMatrix, EmptyRowsAreFine) {
  FormFactorMatrix form_factors = make_form_factors(2, 2);
  append_row(form_factors.blocks[0], {});
  append_row(form_factors.blocks[0], {});
  finish_blocks(form_factors);
  std::vector<double> out(2, 7);
  multiply(form_factors, std::vector<double>{1, 1}, out);
  EXPECT_EQ(out, (std::vector<double>{0, 0}));
  EXPECT_EQ(form_factors.count(), 0u);
  for (const double sum : row_sums(form_factors)) EXPECT_EQ(sum, 0);
}

}  // namespace
}  // namespace hemibake
