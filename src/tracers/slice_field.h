// The heights laid out for slices: with margins, so that a piece of path reads them without asking for the edge, and
// with the tallest height of square windows, so that a walk skips what lies below its horizon.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "surface/surface.h"

namespace hemibake {

inline constexpr int kSliceLanes = 16;    // receivers of a packet, neighbours along x
inline constexpr int kSegmentCells = 8;   // a segment of a path spans this along x or y, the longer
inline constexpr int kSkipLevels = 3;
inline constexpr int kSkipSegments[kSkipLevels] = {1, 4, 16};  // segments a window of each level covers

// Slopes from a receiver to "nothing there" lose against every other; differences of two such heights stay finite.
inline constexpr float kNoHeight = -1e30f;

struct SliceField {
  int width = 0, height = 0;
  bool wrap = true;
  float top = 0;  // height of the highest texel, in texels, as all heights here

  // Planes hold the texel (x, y) at index(x, y). On a wrapping map any x in -1..width-1 may be followed by a packet
  // and a segment, on an open one also positions from which a window just reaches the map.
  std::vector<float> heights;
  // [level](x, y): tallest corner in x … x + s − 1 and y … y + s − 1, where s = kSegmentCells · segments + 2.
  std::array<std::vector<float>, kSkipLevels> tallest;
  int margin_left = 0, margin_above = 0;
  size_t pitch = 0;

  size_t index(int x, int y) const {
    return static_cast<size_t>(y + margin_above) * pitch + static_cast<size_t>(x + margin_left);
  }
};

SliceField make_slice_field(const Surface& surface);

}  // namespace hemibake
