// Walks a path from all texels of a row, packets of neighbours at once.
#pragma once

#include <array>
#include <span>

#include "terrain/horizon_field.h"
#include "terrain/horizon_path.h"

namespace hemibake {

struct HorizonWalk {
  const HorizonField& field;
  const HorizonPath& path;
  std::array<WindowMaxima, kWindowLevels> maxima;  // of the path's windows, for all lanes of a packet
  float lowest_slope;                              // of a horizon; −∞ where it may be anything
  bool drops;                                      // by a curvature
};

// Finds the slopes of the horizons of row y. slopes: of the map's width.
void walk_row(const HorizonWalk& walk, int y, std::span<float> slopes);

}  // namespace hemibake
