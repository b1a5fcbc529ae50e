// Makes land: dunes, and mountains. Lengths and heights are in units of the map's longer side.
#include <algorithm>
#include <cmath>

#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

// Returns a wave of period 1 that rises slowly over `share` of it and falls in the rest, 0..1.
double lee_wave(double phase, double share) {
  const double t = phase - std::floor(phase);
  return t < share ? smooth_step(0, share, t) : 1 - (t - share) / (1 - share);
}

}  // namespace

// Makes four crests across x that bend and fork, with a lee side three times as steep as the windward one,
// and ripples on top.
Grid<float> make_dunes(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 12, stream); };
  const int crests = cells_along(tile.width, 4), ripples = cells_along(tile.width, 40);
  const FractalNoise bend{.frequency = 2, .highest_frequency = 8, .gain = 0.4, .seed = seed(0)};
  const FractalNoise swell{.frequency = 3, .highest_frequency = 12, .gain = 0.5, .seed = seed(1)};
  const FractalNoise sand{.frequency = 12, .highest_frequency = 48, .gain = 0.5, .seed = seed(2)};
  return fill_points(options, [&](double x, double y) {
    const double bent = 0.75 * fractal_noise(x, y, tile, bend);
    const double size = 0.75 + 0.6 * fractal_noise(x, y, tile, swell);
    const double across = x / tile.width;
    const double dune = 0.06 * size * lee_wave(crests * across + bent, 0.75);
    const double ripple = lee_wave(ripples * across + 6 * bent + fractal_noise(x, y, tile, sand), 0.65);
    return dune + 0.0025 * ripple + 0.002 * fractal_noise(x, y, tile, sand);
  });
}

// Makes a ridged multifractal (Musgrave, "Texturing and Modeling", 1994: octaves of (1 − |noise|)², each
// weighted by the ridges it stands on), low ground smoothed as by what was washed down.
Grid<float> make_terrain(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const double highest = highest_frequency(options);
  return fill_points(options, [&](double x, double y) {
    double height = 0, weight = 1, amplitude = 1, frequency = 3;
    int octave = 0;
    do {
      const double ridge =
          1 - std::abs(2 * tile_noise(x, y, tile, frequency, hash_bits(options.seed, 13, octave++)));
      const double signal = ridge * ridge * weight;
      height += amplitude * signal;
      weight = std::clamp(1.6 * signal, 0.0, 1.0);
      amplitude *= 0.42;
      frequency *= 2;
    } while (frequency <= highest);
    // Valley floors: below the bend the slope goes down to a fifth.
    constexpr double kBend = 0.55, kFill = 0.2;
    return height < kBend ? kBend + kFill * (height - kBend) : height;
  });
}

}  // namespace hemibake
