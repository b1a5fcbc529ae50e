// The heights laid out for slices: with margins, so that a piece of path reads them without asking for the
// edge, and with the tallest height of square windows, so that a walk skips what lies below its horizon.
#pragma once

#include <array>
#include <cstddef>

#include "core/large_pages.h"
#include "surface/surface.h"

namespace hemibake {

inline constexpr int kSliceLanes = 16;   // receivers of a packet, neighbours along x
inline constexpr int kSegmentCells = 8;  // a segment of a path spans this along x or y, whichever is longer
inline constexpr int kSkipLevels = 4;
inline constexpr int kSkipSegments[kSkipLevels] = {1, 1, 4,
                                                   16};  // segments that a window of each level covers
inline constexpr int kFarSegments = 8;  // from here on the second level, small but coarse, is asked first

// Height of nothing: lower than every slope asks for, and differences of two of them stay finite.
inline constexpr float kNoHeight = -1e30f;

// Heights by place, in vertical strips: what lies along a path up or down the map is on few pages of memory.
// Strips overlap by what a packet and a segment reach beyond one. The texel (x, y) stands at index(x, y).
struct HeightPlane {
  LargePageVector<float> values;
  size_t pitch = 0;       // from a row of a strip to the next
  size_t strip_size = 0;  // from a strip to the next
  int strip_shift = 30;   // strips are 2^strip_shift columns apart
  int margin_left = 0, margin_above = 0;
  int row_shift = 0;     // 2^row_shift rows of texels share a row of the plane
  int column_shift = 0;  // the same of columns

  size_t index(int x, int y) const {
    const size_t column = static_cast<size_t>((x + margin_left) >> column_shift);
    const size_t row = static_cast<size_t>((y + margin_above) >> row_shift);
    return (column >> strip_shift) * strip_size + row * pitch + (column & ((size_t{1} << strip_shift) - 1));
  }
  const float* at(int x, int y) const { return values.data() + index(x, y); }
};

struct HeightPyramid {
  int width = 0, height = 0;
  double inverse_width = 0, inverse_height = 0;
  bool wrap = true;
  float top = 0;  // height of the highest texel, in texels, as all heights here

  // Any position from -1, -1 on may be followed by a packet and a segment; on an open map also positions
  // before it from which a window just reaches the map.
  HeightPlane heights;
  // [level] at (x, y): at least the tallest corner in x … x + s − 1 and y … y + s − 1, where
  // s = kSegmentCells · kSkipSegments[level] + 2; of all the lanes of a packet from (x, y) on where columns
  // are shared.
  std::array<HeightPlane, kSkipLevels> tallest;
};

HeightPyramid make_height_pyramid(const Surface& surface);

}  // namespace hemibake
