// Makes hashes and tileable noise for synthetic maps. Everything starts from integer hashes, so that a seed
// gives the same map on every machine and at any thread count.
#pragma once

#include <cstdint>

namespace hemibake {

// A rectangle that repeats for ever, in units of its longer side.
struct Tile {
  double width = 1;   // in (0, 1]
  double height = 1;  // in (0, 1]
};

// Returns the lattice cells along one side of a tile: about `frequency` per unit, at least 1.
int cells_along(double side, double frequency);

// Returns 64 well-mixed bits of a seed and two integers (mix_bits).
uint64_t hash_bits(uint64_t seed, int64_t x, int64_t y);

// Returns a number in [0, 1) of a seed and two integers.
double hash_unit(uint64_t seed, int64_t x, int64_t y);

// Returns 0 below `low`, 1 above `high`, the cubic 3t² − 2t³ in between. low < high.
double smooth_step(double low, double high, double value);

// Returns gradient noise (Perlin 2002, quintic fade; gradients uniform in the square [−1, 1]²), within ±1.
// (x, y): any point, in units of the tile's longer side. frequency: lattice cells per unit, rounded so that a
// whole number fits the tile.
double tile_noise(double x, double y, Tile tile, double frequency, uint64_t seed);

// Sums octaves of gradient noise, one per doubling of the frequency.
struct FractalNoise {
  double frequency = 4;            // of the first octave, cells per unit
  double highest_frequency = 256;  // octaves above this one are left out; at least the first is kept
  double gain = 0.5;               // amplitude of an octave over that of the one before, in (0, 1)
  uint64_t seed = 0;
};
double fractal_noise(double x, double y, Tile tile, const FractalNoise& noise);

// Returns the nearest of scattered round spots, one in every cell of the tile.
struct Spot {
  double distance;  // from (x, y) to the centre, units of the longer side
  uint64_t bits;    // hashed, of the spot: for its size, depth and the like
};
Spot nearest_spot(double x, double y, Tile tile, double frequency, uint64_t seed);

// Returns the Voronoi cell that a point lies in, of one site in every lattice cell of the tile.
struct VoronoiCell {
  double x, y;    // from the site to the point, units of the longer side
  double border;  // distance to the nearest bisector with another site, 0..
  uint64_t bits;  // hashed, of the site: for its size, height and the like
};
// jitter: how far sites leave the centres of their lattice cells, 0 (not at all) to 1 (anywhere in them).
VoronoiCell voronoi_cell(double x, double y, Tile tile, double frequency, double jitter, uint64_t seed);

}  // namespace hemibake
