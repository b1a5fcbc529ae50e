// Makes floors laid of equal pieces: wooden boards, and square tiles. Lengths and heights are in units of the
// map's longer side.
#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>

#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

// Returns a number uniform in [−1, 1) of a piece.
double random_of(uint64_t bits, int trait) { return 2 * hash_unit(bits, 3, trait) - 1; }

// One piece of a floor and a point in its frame.
struct PiecePoint {
  double x, y;    // from the centre
  double inside;  // distance to the nearest side of its cell
  uint64_t bits;
};

// Returns the piece at a point of a floor of pieces. cells: columns and rows. shift: of row j, in columns.
template <class Shift>
PiecePoint piece_at(double x, double y, Tile tile, glm::ivec2 cells, uint64_t seed, const Shift& shift) {
  const int columns = cells.x, rows = cells.y;
  // Half a cell on, so that the map's border runs through pieces.
  const double v = y / tile.height * rows + 0.5;
  const int row = wrap_index(static_cast<int>(std::floor(v)), rows);
  const double u = x / tile.width * columns + 0.5 + shift(row);
  const int column = wrap_index(static_cast<int>(std::floor(u)), columns);
  const double width = tile.width / columns, height = tile.height / rows;
  PiecePoint piece{(u - std::floor(u) - 0.5) * width, (v - std::floor(v) - 0.5) * height, 0,
                   hash_bits(seed, column, row)};
  piece.inside = std::min(width / 2 - std::abs(piece.x), height / 2 - std::abs(piece.y));
  return piece;
}

// Returns noise whose features are `stretch` times as long along x as along y.
double grain_noise(double x, double y, Tile tile, double stretch, const FractalNoise& noise) {
  return fractal_noise(x / stretch, y, {tile.width / stretch, tile.height}, noise);
}

}  // namespace

// Makes boards along x, 1/7 wide and half the map long, joints staggered: cupped, warped, with grain along
// them and gaps between them.
Grid<float> make_planks(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const int columns = cells_along(tile.width, 2), rows = cells_along(tile.height, 7);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 6, stream); };
  const FractalNoise grain{
      .frequency = 45, .highest_frequency = highest_frequency(options), .gain = 0.7, .seed = seed(0)};
  const FractalNoise rot{.frequency = 14, .highest_frequency = 60, .gain = 0.6, .seed = seed(1)};
  return fill_points(options, [&](double x, double y) {
    const PiecePoint board =
        piece_at(x, y, tile, {columns, rows}, seed(2), [&](int row) { return hash_unit(seed(3), row, 0); });
    // Rot eats at the sides here and there.
    const double eaten = 0.012 * smooth_step(0.1, 0.7, grain_noise(x, y, tile, 3, rot));
    const double inside = board.inside - 0.005 - eaten;
    if (inside <= 0) return 0.0;
    const double edge = std::min(1.0, inside / 0.006);
    const double half = tile.height / rows / 2, across = board.y / half;
    const double top =
        0.04 + 0.005 * random_of(board.bits, 0) + 0.05 * random_of(board.bits, 1) * board.y +
        0.004 * random_of(board.bits, 2) * across * across + 0.012 * random_of(board.bits, 4) * board.x +
        0.006 * grain_noise(x + 0.31 * random_of(board.bits, 3) * tile.width, y, tile, 8, grain);
    return top * std::sqrt(edge * (2 - edge));
  });
}

// Makes tiles 1/6 wide with rounded edges: one in five sags, one in twelve is gone.
Grid<float> make_tiles(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const int columns = cells_along(tile.width, 6), rows = cells_along(tile.height, 6);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 7, stream); };
  const FractalNoise mortar{
      .frequency = 40, .highest_frequency = highest_frequency(options), .gain = 0.6, .seed = seed(0)};
  return fill_points(options, [&](double x, double y) {
    const PiecePoint piece = piece_at(x, y, tile, {columns, rows}, seed(1), [](int) { return 0.0; });
    const double bed = 0.0015 * fractal_noise(x, y, tile, mortar);
    const double joint = 0.012 + bed;
    const double inside = piece.inside - 0.007;
    if (inside <= 0) return joint;
    if (hash_unit(piece.bits, 5, 0) < 1.0 / 12) return std::min(joint, bed + std::max(0.0, joint - inside));
    const double sag = hash_unit(piece.bits, 5, 1) < 0.2 ? 0.09 : 0.015;
    const double top =
        0.036 + sag * (random_of(piece.bits, 0) * piece.x + random_of(piece.bits, 1) * piece.y);
    const double from_top = 1 - std::min(1.0, inside / 0.012);
    return std::max(joint, joint + (top - joint) * std::sqrt(1 - from_top * from_top));
  });
}

}  // namespace hemibake
