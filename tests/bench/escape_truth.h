// The maps of the escape bench and the truth of their light: E/π of all bounces, converged, at every texel.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/grid.h"

namespace hemibake {

// Albedos with a truth; the first kModelAlbedos are those that forms of g are judged at.
inline constexpr std::array kTruthAlbedos = {0.2, 0.5, 0.8, 0.9, 0.95, 0.85};
inline constexpr size_t kModelAlbedos = 5;

// Light under an albedo that varies over the map.
struct PaintedTruth {
  std::string pattern;
  Grid<float> albedo;      // one per texel
  Grid<float> irradiance;  // E/π of all bounces
};

struct MapTruth {
  std::string name, kind;
  bool usual = false;  // a material at its recommended amplitude
  double height_range_texels = 0;
  Grid<float> visibility, escape, normal_z;  // V, α, n.z
  std::array<Grid<float>, kTruthAlbedos.size()> irradiance;
  std::vector<PaintedTruth> painted;  // of some maps

  size_t size() const { return visibility.size(); }
};

// Bakes every map, or takes it from the folder where it was kept by an earlier run. Prints a line a map.
// side: texels along a side of the synthetic maps. folder: empty: nothing is kept.
std::vector<MapTruth> bake_truths(int side, int azimuths, const std::filesystem::path& folder);

}  // namespace hemibake
