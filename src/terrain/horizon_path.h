// The path that all texels of a map look along at one azimuth, and where it meets the edges of the triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace hemibake {

inline constexpr int kHorizonLanes = 16;  // texels of a packet, neighbours along a row

// Pieces of a path, 8 texels along x or y, whichever is longer, that one window of each level covers.
inline constexpr int kPieceTexels = 8;
inline constexpr std::array<int, 3> kWindowPieces = {1, 6, 36};
inline constexpr size_t kWindowLevels = kWindowPieces.size();

// Texels: a path this close to a texel centre goes through it.
inline constexpr double kOnTexel = 1e-9;

// Crossing with an edge of a triangle. Distances in texels.
struct HorizonCrossing {
  int32_t a, b;  // offsets of the edge's ends from the corner of the piece
  float fraction, inverse_distance;
  float drop;  // of the slope, by the curvature
};

// Square window that the stretch of a path stays in, for one texel.
struct HorizonWindow {
  int corner_x, corner_y;                 // from the start
  float near, inverse_near, inverse_far;  // distances of its ends, texels
  float drop;                             // of the slope at the near end
};

struct HorizonPiece {
  uint32_t first, end;  // crossings
};

struct HorizonPath {
  double x, y;  // direction, unit
  std::vector<HorizonCrossing> crossings;
  std::vector<HorizonPiece> pieces;
  // By level; window k covers the pieces from k · kWindowPieces[level] on.
  std::array<std::vector<HorizonWindow>, kWindowLevels> windows;
};

// Returns the size of a level's windows along one axis, texels.
// direction: of the path along this axis; other: along the other.
int window_texels(double direction, double other, size_t level);

// Finds the path of an azimuth.
// azimuth: radians, clockwise from up. longest: texels. drop: 1/texels. pitch: texels from a row to the next.
HorizonPath find_horizon_path(double azimuth, double longest, double drop, int pitch);

}  // namespace hemibake
