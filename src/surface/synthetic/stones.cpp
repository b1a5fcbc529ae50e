// Makes loose stones: cobbles set in sand, and gravel. Lengths and heights are in units of the map's longer
// side.
#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

// Returns a number uniform in [−1, 1) of a stone.
double random_of(uint64_t bits, int trait) { return 2 * hash_unit(bits, 3, trait) - 1; }

// Returns the height of a rounded stone over its foot: a quarter of an ellipse from the border inwards.
double rounded(double inside, double rounding) {
  const double from_top = 1 - std::clamp(inside / rounding, 0.0, 1.0);
  return std::sqrt(1 - from_top * from_top);
}

// One layer of pebbles: the highest of the ellipsoids around a point.
struct PebbleLayer {
  double frequency;  // lattice cells per unit, one pebble in each
  double radius;     // the largest, units of the longer side
  double lift;       // of the highest centre over the ground
};

constexpr PebbleLayer kPebbleLayers[] = {{9, 0.075, 0.03}, {17, 0.042, 0.045}, {34, 0.022, 0.055}};

double pebble_height(double dx, double dy, const PebbleLayer& layer, uint64_t bits) {
  const double turn = kPi * random_of(bits, 0);
  const double along = std::cos(turn) * dx + std::sin(turn) * dy;
  const double across = std::cos(turn) * dy - std::sin(turn) * dx;
  const double radius = layer.radius * (0.8 + 0.2 * random_of(bits, 1));
  const double breadth = radius * (0.75 + 0.15 * random_of(bits, 2));
  const double squared = along * along / (radius * radius) + across * across / (breadth * breadth);
  if (squared >= 1) return 0;
  const double centre = layer.lift * hash_unit(bits, 4, 0);
  return std::max(0.0, centre + 0.7 * breadth * std::sqrt(1 - squared));
}

double layer_height(double x, double y, Tile tile, const PebbleLayer& layer, uint64_t seed) {
  const int cells_x = cells_along(tile.width, layer.frequency);
  const int cells_y = cells_along(tile.height, layer.frequency);
  const double u = x / tile.width * cells_x, v = y / tile.height * cells_y;
  const int cell_x = static_cast<int>(std::floor(u)), cell_y = static_cast<int>(std::floor(v));
  double highest = 0;
  for (int j = cell_y - 1; j <= cell_y + 1; ++j) {
    for (int i = cell_x - 1; i <= cell_x + 1; ++i) {
      const uint64_t bits = hash_bits(seed, wrap_index(i, cells_x), wrap_index(j, cells_y));
      const double dx = (u - i - hash_unit(bits, 0, 0)) * tile.width / cells_x;
      const double dy = (v - j - hash_unit(bits, 0, 1)) * tile.height / cells_y;
      highest = std::max(highest, pebble_height(dx, dy, layer, bits));
    }
  }
  return highest;
}

}  // namespace

// Makes stones about 0.14 wide, each set a little higher or lower and tilted, with sand between them.
Grid<float> make_cobbles(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const double highest = highest_frequency(options);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 4, stream); };
  const FractalNoise sand{.frequency = 30, .highest_frequency = highest, .gain = 0.6, .seed = seed(0)};
  const FractalNoise skin{.frequency = 18, .highest_frequency = highest, .gain = 0.5, .seed = seed(1)};
  return fill_points(options, [&](double x, double y) {
    const VoronoiCell cell = voronoi_cell(x, y, tile, 7, 0.6, seed(2));
    const double ground = 0.004 * fractal_noise(x, y, tile, sand);
    const double inside = cell.border - 0.006;
    if (inside <= 0) return ground;
    const double top = 0.05 + 0.007 * random_of(cell.bits, 0) + 0.10 * random_of(cell.bits, 1) * cell.x +
                       0.10 * random_of(cell.bits, 2) * cell.y + 0.004 * fractal_noise(x, y, tile, skin);
    return std::max(ground, top * rounded(inside, 0.05));
  });
}

// Makes a bed of pebbles 0.02 to 0.07 in radius: what stands highest is seen.
Grid<float> make_gravel(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const FractalNoise grain{.frequency = 40,
                           .highest_frequency = highest_frequency(options),
                           .gain = 0.6,
                           .seed = hash_bits(options.seed, 5, 0)};
  return fill_points(options, [&](double x, double y) {
    double height = 0.004 * fractal_noise(x, y, tile, grain);
    int stream = 1;
    for (const PebbleLayer& layer : kPebbleLayers)
      height = std::max(height, layer_height(x, y, tile, layer, hash_bits(options.seed, 5, stream++)));
    return height + 0.0012 * fractal_noise(x, y, tile, grain);
  });
}

}  // namespace hemibake
