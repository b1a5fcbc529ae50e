// Finds the horizon of every texel at one azimuth: the steepest slope from its centre to the surface.
//
// Exact on the triangles of surface/facets.h, in double precision: a path meets the edges of the triangles at
// crossings, and the horizon is the steepest of them, since a triangle in a vertical plane is a straight
// line. The crossings of an azimuth are the same for all texels. Windows of them that max mips show to be
// below the horizon are skipped.
//
// Ground edges: the ground goes on level with the border where the path leaves the map. A wrapping map is
// followed for 10⁴ height ranges, at most 65536 texels: its horizon is at least 0, low by at most the height
// range over that distance. Open edges: −∞ where a path meets nothing.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

struct HorizonReach {
  double radius_m = std::numeric_limits<double>::infinity();  // farther crossings do not count, > 0
  double drop_per_m2 = 0;  // heights at distance d count as lower by this times d², 1/m
};

class HorizonTracer {
 public:
  // Copies the heights, and makes their max mips.
  // inverted: of the surface upside down, for negative openness.
  HorizonTracer(const Surface& surface, const HorizonReach& reach, bool inverted);

  // Returns the slopes (tangents of the elevation) of the horizon of all texels.
  // azimuth: radians, clockwise from up in the image (north).
  Grid<float> trace(double azimuth) const;

 private:
  struct Crossing {
    int32_t a, b;  // offsets of the edge's ends from the corner of the piece
    double fraction, distance;
  };
  // Square window of texels that a stretch of a path stays in.
  struct Window {
    int corner_x, corner_y;  // from the start
    double near, far;        // distances of its ends
  };
  struct Piece {
    Window window;
    uint32_t first, end;  // crossings
  };
  struct Path {
    double x, y;  // direction, unit
    std::vector<Crossing> crossings;
    std::vector<Piece> pieces;
    std::vector<Window> groups;  // of kGroupPieces pieces
  };
  // Maxima over two blocks a side, from each block on.
  struct MaxMip {
    int block;
    Grid<float> values;
  };

  Path make_path(double azimuth) const;
  MaxMip make_max_mip(int block) const;
  bool is_below(const MaxMip& mip, const Window& window, int x, int y, double slope) const;
  double horizon(const Path& path, int x, int y) const;
  double distance_to_border(const Path& path, int x, int y) const;
  double ground_slope(const Path& path, int x, int y, double border) const;

  int width_, height_;
  Edge edge_;
  Grid<float> heights_;  // texels; repeated a little to the right and below where the map wraps
  double top_ = 0;
  double radius_, drop_;  // texels; per texel
  double longest_;        // of a path, texels
  double lowest_slope_;   // of a horizon
  std::array<MaxMip, 2> max_mips_;
};

}  // namespace hemibake
