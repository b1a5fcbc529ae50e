// Makes a plain weave: strands along x and y that pass over and under one another. Lengths and heights are in
// units of the map's longer side.
#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

struct Strands {
  int count;      // across the map, even: over and under alternate where the map repeats
  double pitch;   // from strand to strand
  double radius;  // of a strand across
  uint64_t seed;
};

// Returns the height of the strands that run along `along`, −1 between them.
// crossings: strands of the other direction at `along`, in strands, their centres at halves.
double strand_height(const Strands& strands, double across, double crossings, bool over_first) {
  const double position = across / strands.pitch;
  const int strand = wrap_index(static_cast<int>(std::floor(position)), strands.count);
  const double size = 0.9 + 0.1 * hash_unit(strands.seed, strand, 0);
  const double offset = (position - std::floor(position) - 0.5) * strands.pitch / (strands.radius * size);
  if (std::abs(offset) >= 1) return -1;
  const double phase = kPi * (crossings + strand + (over_first ? 0 : 1));
  const double rise = std::sin(phase) * 0.55 * strands.radius;
  return rise + size * 0.8 * strands.radius * std::sqrt(1 - offset * offset);
}

}  // namespace

// Makes twelve strands a side, each of its own thickness, with fibres along them.
Grid<float> make_weave(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 8, stream); };
  const int columns = 2 * cells_along(tile.width, 6), rows = 2 * cells_along(tile.height, 6);
  const double pitch_x = tile.width / columns, pitch_y = tile.height / rows;
  const double radius = 0.46 * std::min(pitch_x, pitch_y);
  const Strands along_y{columns, pitch_x, radius, seed(0)}, along_x{rows, pitch_y, radius, seed(1)};
  const FractalNoise fibre{
      .frequency = 40, .highest_frequency = highest_frequency(options), .gain = 0.6, .seed = seed(2)};
  return fill_points(options, [&](double x, double y) {
    // A quarter of a strand on, so that the map's border runs through strands.
    x += pitch_x / 4, y += pitch_y / 4;
    const double warp = strand_height(along_y, x, y / pitch_y, true);
    const double weft = strand_height(along_x, y, x / pitch_x, false);
    const double top = std::max({warp, weft, -1.2 * radius});
    return top + 0.05 * radius * fractal_noise(x, y, tile, fibre);
  });
}

}  // namespace hemibake
