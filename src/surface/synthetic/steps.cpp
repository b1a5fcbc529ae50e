// Makes things cut into steps and walls: flights of stairs, and trenches. Lengths and heights are in units of
// the map's longer side.
#include <algorithm>
#include <cmath>

#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

// Width that a wall takes, so that it is not thinner than a texel on small maps.
constexpr double kDraft = 0.01;

}  // namespace

// Makes four flights side by side along x, each climbing half the map and descending the other half from a
// place of its own, so that steep walls stand between them.
Grid<float> make_stairs(const SyntheticOptions& options) {
  constexpr double kRise = 0.6;  // height over length of a flight
  const Tile tile = tile_of(options);
  const int flights = cells_along(tile.height, 4), steps = 2 * cells_along(tile.width, 8);
  const double breadth = tile.height / flights, tread = tile.width / steps;
  const auto seed = [&](int stream) { return hash_bits(options.seed, 10, stream); };
  const FractalNoise wear{
      .frequency = 20, .highest_frequency = highest_frequency(options), .gain = 0.5, .seed = seed(0)};
  const auto level = [&](int flight, int step) {
    const int start = static_cast<int>(steps * hash_unit(seed(1), wrap_index(flight, flights), 0));
    const int climbed = wrap_index(step + start, steps);
    return kRise * tread * std::min(climbed, steps - climbed);
  };
  return fill_points(options, [&](double x, double y) {
    // Half a flight and half a tread on, so that the map's border cuts no wall.
    const double across = y / breadth + 0.5, along = x / tread + 0.5;
    const int flight = static_cast<int>(std::floor(across)), step = static_cast<int>(std::floor(along));
    const double riser = std::min(1.0, (along - step) * tread / kDraft);
    const double side = std::min(1.0, (across - flight) * breadth / kDraft);
    const auto climbed = [&](int of) { return std::lerp(level(of, step - 1), level(of, step), riser); };
    return std::lerp(climbed(flight - 1), climbed(flight), side) + 0.0015 * fractal_noise(x, y, tile, wear);
  });
}

// Makes trenches of one depth along the zero lines of a noise, shallow ditches along those of another.
Grid<float> make_trenches(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const auto seed = [&](int stream) { return hash_bits(options.seed, 11, stream); };
  const FractalNoise course{.frequency = 3, .highest_frequency = 16, .gain = 0.35, .seed = seed(0)};
  const FractalNoise ditches{.frequency = 3, .highest_frequency = 12, .gain = 0.35, .seed = seed(1)};
  const FractalNoise ground{
      .frequency = 16, .highest_frequency = highest_frequency(options), .gain = 0.5, .seed = seed(2)};
  // Returns the distance to the zero line, about: the noise over its slope.
  const auto from_line = [&](double x, double y, const FractalNoise& noise) {
    constexpr double kStep = 1e-4;
    const double value = fractal_noise(x, y, tile, noise);
    const double slope_x = (fractal_noise(x + kStep, y, tile, noise) - value) / kStep;
    const double slope_y = (fractal_noise(x, y + kStep, tile, noise) - value) / kStep;
    return std::abs(value) / std::max(1.0, std::hypot(slope_x, slope_y));
  };
  return fill_points(options, [&](double x, double y) {
    const double deep = 1 - std::clamp((from_line(x, y, course) - 0.02) / kDraft, 0.0, 1.0);
    const double shallow = 1 - std::clamp((from_line(x, y, ditches) - 0.006) / kDraft, 0.0, 1.0);
    return 0.004 * fractal_noise(x, y, tile, ground) - std::max(0.1 * deep, 0.04 * shallow);
  });
}

}  // namespace hemibake
