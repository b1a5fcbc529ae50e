// One run of the trade study: a method at one setting, and what it makes of a surface.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bake/target_error.h"
#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// What a run found, one value per texel. Planes the method does not give are empty.
struct RunPlanes {
  Grid<float> uniform;                                         // α
  Grid<float> cosine;                                          // E₀/π
  Grid<float> first_bounce;                                    // E₁/π at albedo 1
  std::array<Grid<float>, kJudgedAlbedos.size()> all_bounces;  // E/π at each of kJudgedAlbedos
  Grid<uint8_t> known;  // 0 where the method has no answer; empty: it has one everywhere
  uint64_t work = 0;    // rays, azimuths, tree nodes, taps or height samples
};

// Every plane with its name in files: "ao", "direct", "first", "light.20", … (the albedo in hundredths).
struct NamedPlane {
  std::string name;
  Grid<float> RunPlanes::*single;  // null: all_bounces[albedo]
  size_t albedo;

  Grid<float>& of(RunPlanes& planes) const { return single ? planes.*single : planes.all_bounces[albedo]; }
  const Grid<float>& of(const RunPlanes& planes) const {
    return single ? planes.*single : planes.all_bounces[albedo];
  }
};
const std::vector<NamedPlane>& named_planes();

// Sums the bounces at each albedo: E/π = Σ ρᵇ E_b/π. irradiance: E_0, E_1, … at albedo 1, 0..π; E_1 is kept
// where there is one.
void add_bounces(const std::vector<Grid<float>>& irradiance, RunPlanes& planes);

struct TradeRun {
  std::string method;               // "embree", "slice", "disk", …: a row of the closing table
  nlohmann::ordered_json settings;  // name: number or string, in words
  std::string series;               // runs that differ in `abscissa` only; empty: of no series
  std::string abscissa_name;        // the setting a series varies
  double abscissa = 0;
  bool representative = false;  // the one good setting of its method
  bool keeps_planes = false;    // written out with their error maps; those of representative runs are too
  // direct: the true E₀ (0..π), for methods that take it as given. Throws Cancelled.
  std::function<RunPlanes(const Surface& surface, const Grid<float>& direct)> perform;

  // Names the run and its files: "embree_rays-64_directions-uniform".
  std::string id() const;
};

}  // namespace hemibake
