// Declares the makers behind synthesize(), one per kind. For surface/synthetic only.
#pragma once

#include <algorithm>

#include "core/parallel.h"
#include "surface/synthetic/noise.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {

// Make the maps of their kinds. options: valid, angle_rad set for kinds that have an angle. Materials may
// return any finite range: synthesize stretches it to 0..1.
Grid<float> make_bricks(const SyntheticOptions& options);
Grid<float> make_shapes(const SyntheticOptions& options);
Grid<float> make_concrete(const SyntheticOptions& options);
Grid<float> make_noise(const SyntheticOptions& options);
Grid<float> make_cobbles(const SyntheticOptions& options);
Grid<float> make_gravel(const SyntheticOptions& options);
Grid<float> make_planks(const SyntheticOptions& options);
Grid<float> make_tiles(const SyntheticOptions& options);
Grid<float> make_weave(const SyntheticOptions& options);
Grid<float> make_mud(const SyntheticOptions& options);
Grid<float> make_stairs(const SyntheticOptions& options);
Grid<float> make_trenches(const SyntheticOptions& options);
Grid<float> make_dunes(const SyntheticOptions& options);
Grid<float> make_terrain(const SyntheticOptions& options);
Grid<float> make_bowl(const SyntheticOptions& options);
Grid<float> make_groove(const SyntheticOptions& options);
Grid<float> make_canyon(const SyntheticOptions& options);
Grid<float> make_step(const SyntheticOptions& options);

// Returns the shape of the map.
inline Tile tile_of(const SyntheticOptions& options) {
  const double longer = std::max(options.width, options.height);
  return {options.width / longer, options.height / longer};
}

// Returns the highest frequency that texels can carry, a lattice cell being two texels.
inline double highest_frequency(const SyntheticOptions& options) {
  return std::max(options.width, options.height) / 2.0;
}

// Fills a map with height(i, j).
template <class Height>
Grid<float> fill_texels(const SyntheticOptions& options, const Height& height) {
  Grid<float> map(options.width, options.height);
  parallel_for(static_cast<size_t>(options.height), 8, [&](size_t begin, size_t end) {
    for (int j = static_cast<int>(begin); j < static_cast<int>(end); ++j)
      for (int i = 0; i < options.width; ++i) map(i, j) = static_cast<float>(height(i, j));
  });
  return map;
}

// Fills a map with height(x, y) at texel centres, in units of the longer side.
template <class Height>
Grid<float> fill_points(const SyntheticOptions& options, const Height& height) {
  const double texel = 1.0 / std::max(options.width, options.height);
  return fill_texels(options, [&](int i, int j) { return height((i + 0.5) * texel, (j + 0.5) * texel); });
}

}  // namespace hemibake
