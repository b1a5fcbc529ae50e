// Finds the horizon of every texel at one azimuth: the steepest slope from its centre to the surface.
//
// Exact on the triangles of surface/facets.h, up to the rounding of floats: a path meets the edges of the
// triangles at crossings, and the horizon is the steepest of them, since a triangle in a vertical plane is a
// straight line. The crossings of an azimuth are the same for all texels, so neighbours walk it together.
// Windows of them that max mips show to be below the horizon are skipped.
//
// Ground edges: the ground goes on level with the border where the path leaves the map. A wrapping map is
// followed for 10⁴ height ranges, at most 65536 texels: its horizon is at least 0, low by at most the height
// range over that distance. Open edges: −∞ where a path meets nothing.
#pragma once

#include <array>
#include <limits>

#include "core/grid.h"
#include "surface/surface.h"
#include "terrain/horizon_field.h"

namespace hemibake {

struct HorizonReach {
  double radius_m = std::numeric_limits<double>::infinity();  // farther crossings do not count, > 0
  double drop_per_m2 = 0;  // heights at distance d count as lower by this times d², 1/m
};

class HorizonTracer {
 public:
  // Copies the heights, and makes the maxima of their blocks.
  // inverted: of the surface upside down, for negative openness.
  HorizonTracer(const Surface& surface, const HorizonReach& reach, bool inverted);

  // Returns the slopes (tangents of the elevation) of the horizon of all texels. The same bytes with every
  // instruction set.
  // azimuth: radians, clockwise from up in the image (north).
  Grid<float> trace(double azimuth) const;

 private:
  // Adds the ground beyond the border to the slopes of row y.
  void add_ground(const HorizonPath& path, int y, Grid<float>& slopes) const;
  double distance_to_border(const HorizonPath& path, int x, int y) const;
  double ground_slope(const HorizonPath& path, int x, int y, double border) const;

  HorizonField field_;
  double radius_, drop_;  // texels; per texel
  double longest_;        // of a path, texels
  double lowest_slope_;   // of a horizon
  std::array<Grid<float>, kWindowLevels> block_maxima_;
};

}  // namespace hemibake
