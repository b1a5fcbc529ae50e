// Lays heights out for slices: with margins, so that a segment reads them without asking for the edge, and
// with the maxima of square windows (max mips), so that a path skips segments below its horizon.
#pragma once

#include <array>
#include <cstddef>

#include "core/large_pages.h"
#include "surface/surface.h"

namespace hemibake {

inline constexpr int kSliceLanes = 16;   // receivers of a packet, neighbours along x
inline constexpr int kSegmentCells = 8;  // a segment of a path spans this along x or y, whichever is longer
inline constexpr int kMipLevels = 4;
// Segments that a window of each level covers.
inline constexpr int kMipSegments[kMipLevels] = {1, 1, 4, 16};
inline constexpr int kFarSegments = 8;  // from here on the second level, small but coarse, comes first

// Sentinel height outside the map: below every horizon, and differences of two of them stay finite.
inline constexpr float kNoHeight = -1e30f;

// Heights in vertical strips: a path up or down the map then meets few pages of memory. Strips overlap by the
// reach of a packet and a segment. The texel (x, y) stands at index(x, y).
struct HeightPlane {
  LargePageVector<float> values;
  size_t pitch = 0;       // from a row of a strip to the next
  size_t strip_size = 0;  // from a strip to the next
  int strip_shift = 30;   // strips are 2^strip_shift columns apart
  int margin_left = 0, margin_above = 0;
  int row_shift = 0;     // 2^row_shift rows of texels share a row of the plane
  int column_shift = 0;  // 2^column_shift columns of texels share a column of the plane

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
  bool ends_at_horizontal = true;  // far away, everything below the horizontal is blocked
  float top = 0;                   // height of the highest texel; all heights here are in texels

  // Readable for a packet and a segment from any position from -1, -1 on; on an open map also from positions
  // before it whose window just reaches the map.
  HeightPlane heights;
  // [level] at (x, y): at least the maximum over x … x + s − 1 and y … y + s − 1, where
  // s = kSegmentCells · kMipSegments[level] + 2; over all lanes of a packet from (x, y) on where columns are
  // shared.
  std::array<HeightPlane, kMipLevels> max_mips;
};

// Builds the pyramid of a surface, in parallel.
HeightPyramid make_height_pyramid(const Surface& surface);

}  // namespace hemibake
