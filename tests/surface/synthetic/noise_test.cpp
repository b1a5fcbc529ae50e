#include "surface/synthetic/noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

// Pinned, so that a change of compiler or machine that would change every map is seen. Values from an
// independent Python implementation with integers modulo 2^64.
TEST(Noise, HashIsTheSameEverywhere) {
  EXPECT_EQ(hash_bits(0, 0, 0), 0x568a9b0b1a2c05ecu);
  EXPECT_EQ(hash_bits(1, 2, 3), 0x8e1e6eacaa45f47fu);
  EXPECT_EQ(hash_bits(7, -1, -5), 0x78a64362792c5e46u);
}

TEST(Noise, UnitNumbersCoverTheirRangeEvenly) {
  EXPECT_EQ(unit_interval(0), 0);
  EXPECT_LT(unit_interval(~uint64_t{0}), 1);
  constexpr int kSide = 300, kCells = 10;
  int counts[kCells] = {};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) ++counts[static_cast<int>(kCells * hash_unit(5, x, y))];
  // Five standard deviations of a binomial count with p = 1/10.
  const double expected = kSide * kSide / kCells, tolerance = 5 * std::sqrt(expected * 0.9);
  for (const int count : counts) EXPECT_NEAR(count, expected, tolerance);
}

TEST(Noise, RepeatsWithTheTile) {
  const Tile tile{1, 0.375};
  const FractalNoise noise{.frequency = 3, .highest_frequency = 64, .gain = 0.6, .seed = 9};
  for (int i = 0; i < 200; ++i) {
    const double x = hash_unit(1, i, 0), y = hash_unit(1, i, 1);
    // Rounding of coordinates times the steepest slope of the octaves.
    EXPECT_NEAR(fractal_noise(x, y, tile, noise),
                fractal_noise(x - tile.width, y + 2 * tile.height, tile, noise), 1e-12);
    EXPECT_NEAR(nearest_spot(x, y, tile, 7, 3).distance,
                nearest_spot(x + tile.width, y - tile.height, tile, 7, 3).distance, 1e-12);
  }
}

TEST(Noise, StaysInRangeAndIsContinuous) {
  const Tile tile;
  constexpr double kStep = 1e-6, kFrequency = 8;
  double lowest = 1, highest = -1;
  for (int i = 0; i < 20000; ++i) {
    const double x = hash_unit(2, i, 0), y = hash_unit(2, i, 1);
    const double value = tile_noise(x, y, tile, kFrequency, 4);
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
    // The slope within a cell is below 8 (gradients up to √2, fades up to 15/8 times differences up to 2).
    EXPECT_NEAR(tile_noise(x + kStep, y, tile, kFrequency, 4), value, 8 * kFrequency * kStep);
  }
  EXPECT_GT(lowest, -1);
  EXPECT_LT(lowest, -0.4);
  EXPECT_GT(highest, 0.4);
  EXPECT_LT(highest, 1);
}

TEST(Noise, VoronoiCellsRepeatWithTheTile) {
  const Tile tile{1, 0.375};
  for (int i = 0; i < 200; ++i) {
    const double x = hash_unit(1, i, 0), y = hash_unit(1, i, 1);
    const VoronoiCell cell = voronoi_cell(x, y, tile, 7, 0.8, 3);
    const VoronoiCell again = voronoi_cell(x - tile.width, y + 2 * tile.height, tile, 7, 0.8, 3);
    EXPECT_EQ(cell.bits, again.bits);
    EXPECT_NEAR(cell.border, again.border, 1e-12);
  }
}

// Unjittered sites stand at the centres of a square lattice, whose bisectors are its lines.
TEST(Noise, VoronoiCellsOfALatticeAreItsSquares) {
  for (int i = 0; i < 200; ++i) {
    const double x = hash_unit(3, i, 0), y = hash_unit(3, i, 1);
    const VoronoiCell cell = voronoi_cell(x, y, {}, 4, 0, 5);
    EXPECT_NEAR(cell.x, x - (std::floor(4 * x) + 0.5) / 4, 1e-12);
    EXPECT_NEAR(cell.y, y - (std::floor(4 * y) + 0.5) / 4, 1e-12);
    EXPECT_NEAR(cell.border, 0.125 - std::max(std::abs(cell.x), std::abs(cell.y)), 1e-12);
  }
}

// A step along the ground changes the distance to the border by no more than itself, also into the next cell.
TEST(Noise, VoronoiBordersAreContinuous) {
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 20000; ++i) {
    const double x = hash_unit(2, i, 0), y = hash_unit(2, i, 1);
    EXPECT_NEAR(voronoi_cell(x + kStep, y, {}, 6, 1, 4).border, voronoi_cell(x, y, {}, 6, 1, 4).border,
                kStep + 1e-12);
  }
}

TEST(Noise, SmoothStep) {
  EXPECT_EQ(smooth_step(1, 3, 0), 0);
  EXPECT_EQ(smooth_step(1, 3, 2), 0.5);
  EXPECT_EQ(smooth_step(1, 3, 4), 1);
}

TEST(Noise, CellsFitTheSide) {
  EXPECT_EQ(cells_along(1, 4), 4);
  EXPECT_EQ(cells_along(0.3, 4), 1);
  EXPECT_EQ(cells_along(1e-9, 4), 1);
}

}  // namespace
}  // namespace hemibake
