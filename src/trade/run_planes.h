// The planes that the runs of a study are compared by.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "bake/settings.h"
#include "bake/target_error.h"
#include "core/grid.h"

namespace hemibake {

// Results of a run, one value per texel. Planes the method does not give are empty.
struct RunPlanes {
  Grid<float> uniform;                                         // α
  Grid<float> cosine;                                          // E₀/π
  Grid<float> first_bounce;                                    // E₁/π at albedo 1
  std::array<Grid<float>, kJudgedAlbedos.size()> all_bounces;  // E/π at each of kJudgedAlbedos
  Grid<uint8_t> known;  // 0 where the method has no answer; empty: it has one everywhere
  uint64_t work = 0;    // rays, azimuths, tree nodes, taps or height samples
};

// Indices into named_planes(). The planes of the albedos follow one another from kLightPlanes on.
inline constexpr size_t kAoPlane = 0, kDirectPlane = 1, kFirstPlane = 2, kLightPlanes = 3;
inline constexpr size_t kPlaneCount = kLightPlanes + kJudgedAlbedos.size();

// A plane by its name in files: "ao", "direct", "first", "light.20", … (the albedo in hundredths).
struct NamedPlane {
  std::string name;
  std::string description;         // one line, ASCII
  Grid<float> RunPlanes::*single;  // null: all_bounces[albedo]
  size_t albedo;                   // index into kJudgedAlbedos

  Grid<float>& of(RunPlanes& planes) const { return single ? planes.*single : planes.all_bounces[albedo]; }
  const Grid<float>& of(const RunPlanes& planes) const {
    return single ? planes.*single : planes.all_bounces[albedo];
  }
};
const std::array<NamedPlane, kPlaneCount>& named_planes();

// Sets first_bounce and all_bounces: E/π = Σ ρᵇ E_b/π at each albedo. Leaves both empty without E_1.
// irradiance: E_0, E_1, … at albedo 1, 0..π.
void add_bounces(const std::vector<Grid<float>>& irradiance, RunPlanes& planes);

struct BakedRun {
  RunPlanes planes;
  std::vector<Grid<float>> irradiance;  // E_0 … E_bounces at albedo 1, 0..π; empty without bounces
};

// Bakes the surface. settings.bounces: 0 gives α and E₀/π only, without links.
BakedRun bake_run(const Surface& surface, BakeSettings settings);

}  // namespace hemibake
