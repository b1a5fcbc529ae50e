// Makes cast concrete: gentle waves from the formwork, the pores that air bubbles left at it, and the grain
// of the sand. Lengths and heights are in units of the map's longer side.
#include <algorithm>
#include <cmath>

#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

// Pores of one size, one in some of the cells of a lattice.
struct PoreSize {
  double frequency;  // cells per unit
  double share;      // of the cells that hold one
  double smallest_radius, largest_radius;
};

constexpr PoreSize kPoreSizes[] = {
    {9, 0.55, 0.004, 0.010},
    {28, 0.5, 0.002, 0.0045},
    {70, 0.4, 0.0010, 0.0022},
};

double pore_depth(double x, double y, Tile tile, const PoreSize& size, uint64_t seed) {
  const Spot spot = nearest_spot(x, y, tile, size.frequency, seed);
  if (hash_unit(spot.bits, 1, 0) > size.share) return 0;
  const double radius = std::lerp(size.smallest_radius, size.largest_radius, hash_unit(spot.bits, 1, 1));
  const double t = spot.distance / radius + 0.25 * tile_noise(x, y, tile, 0.4 / radius, spot.bits);
  // The part of a sphere under a skin that hid its upper half: shallower than round.
  return t < 1 ? 0.8 * radius * std::pow(1 - t * t, 0.7) : 0.0;
}

}  // namespace

Grid<float> make_concrete(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const double highest = highest_frequency(options);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 2, stream); };
  const FractalNoise waves{.frequency = 3, .highest_frequency = 12, .gain = 0.45, .seed = seed(0)};
  const FractalNoise lumps{.frequency = 20, .highest_frequency = highest, .gain = 0.5, .seed = seed(1)};
  const FractalNoise grain{.frequency = 110, .highest_frequency = highest, .gain = 0.8, .seed = seed(2)};
  return fill_points(options, [&](double x, double y) {
    double height = 0.022 * fractal_noise(x, y, tile, waves) + 0.003 * fractal_noise(x, y, tile, lumps) +
                    0.0016 * fractal_noise(x, y, tile, grain);
    int stream = 3;
    for (const PoreSize& size : kPoreSizes) height -= pore_depth(x, y, tile, size, seed(stream++));
    return height;
  });
}

}  // namespace hemibake
