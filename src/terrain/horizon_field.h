// The heights of a map laid out for horizons: with margins, so that a packet of texels reads a piece of a
// path without asking for the edge; and the maxima of windows, so that a path skips pieces below the horizon.
#pragma once

#include "core/grid.h"
#include "surface/surface.h"
#include "terrain/horizon_path.h"

namespace hemibake {

// Height outside the map: below every horizon, and differences of two of them stay finite.
inline constexpr float kNoHeight = -1e30f;
// Slopes below this come of kNoHeight.
inline constexpr float kNoSlope = -1e18f;

struct HorizonField {
  int width, height;
  Edge edge;
  Grid<float> heights;  // texels, with a margin on every side
  float top;            // of all heights

  // Lays out the heights of a surface. inverted: of the surface upside down.
  HorizonField(const Surface& surface, bool inverted);
  const float* at(int x, int y) const {
    return heights.values.data() + std::ptrdiff_t{y + kMargin} * heights.width + x + kMargin;
  }
  // Readable beyond the border: a packet and a piece.
  static constexpr int kMargin = kHorizonLanes + kPieceTexels + 8;
};

// Maxima of square blocks of the map.
Grid<float> block_maxima(const HorizonField& field, int block);

// Maxima over windows of one size, from every block on.
class WindowMaxima {
 public:
  WindowMaxima() = default;
  // Makes the maxima. blocks: of block_maxima. size_x, size_y: of the windows, texels.
  WindowMaxima(const HorizonField& field, const Grid<float>& blocks, int block, int size_x, int size_y);

  // Returns at least the maximum of the map within the window from (x, y) on, and at most that of a window
  // larger by a block. x, y: in 0..n−1 where the map wraps.
  float at(int x, int y) const {
    const int u = (x >> shift_) - first_x_, v = (y >> shift_) - first_y_;
    if (u < 0 || v < 0 || u >= maxima_.width || v >= maxima_.height) return kNoHeight;
    return maxima_(u, v);
  }

 private:
  int shift_ = 0, first_x_ = 0, first_y_ = 0;
  Grid<float> maxima_;
};

}  // namespace hemibake
