// Makes dried mud: plates with curled rims between wide cracks, each plate cut again by finer ones. Lengths
// and heights are in units of the map's longer side.
#include <algorithm>
#include <cmath>

#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

// Returns the depth of a crack at a distance from its middle, as a share: walls that lean a little.
double crack(double from_middle, double half_width) {
  return 1 - smooth_step(0.35 * half_width, half_width, from_middle);
}

}  // namespace

Grid<float> make_mud(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 9, stream); };
  const FractalNoise wander{.frequency = 9, .highest_frequency = 72, .gain = 0.5, .seed = seed(0)};
  const FractalNoise wander_across{.frequency = 9, .highest_frequency = 72, .gain = 0.5, .seed = seed(1)};
  const FractalNoise skin{
      .frequency = 24, .highest_frequency = highest_frequency(options), .gain = 0.6, .seed = seed(2)};
  return fill_points(options, [&](double x, double y) {
    // Cracks wander: the cells are looked up at a warped point.
    const double warped_x = x + 0.02 * fractal_noise(x, y, tile, wander);
    const double warped_y = y + 0.02 * fractal_noise(x, y, tile, wander_across);
    const VoronoiCell plate = voronoi_cell(warped_x, warped_y, tile, 5, 0.9, seed(3));
    const VoronoiCell piece = voronoi_cell(warped_x, warped_y, tile, 13, 1, seed(4));
    const double curl = 0.014 * std::exp(-plate.border / 0.02) * (0.5 + hash_unit(plate.bits, 1, 0));
    const double top = 0.05 + 0.006 * hash_unit(plate.bits, 1, 1) + curl +
                       0.004 * fractal_noise(x, y, tile, skin) - 0.016 * crack(piece.border, 0.007);
    return top * (1 - crack(plate.border, 0.012)) + 0.004 * fractal_noise(x, y, tile, skin);
  });
}

}  // namespace hemibake
