#include "tracers/slice/height_pyramid.h"

#include <algorithm>

#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr size_t kRowsPerPiece = 16;

// A quarter to a half of a window's size: windows grow little by it and fit the caches. Larger windows lie
// far from a receiver and fit only if all lanes of a packet share one.
constexpr int kRowShift[kMipLevels] = {2, 3, 4, 5};
constexpr int kColumnShift[kMipLevels] = {0, 3, 4, 5};

constexpr int kStripShift = 7;  // narrower strips: fewer pages, more overlap

constexpr int window_size(int level) { return kSegmentCells * kMipSegments[level] + 2; }

// Columns to the right of the first corner of a packet's nearest window; a crossing may round to one before
// it.
constexpr int kReach = window_size(0) + 2 + kSliceLanes;

// Returns the heights with the margins that packets and segments reach.
HeightPlane margined_heights(const Surface& surface, bool wrap) {
  const int width = surface.width(), height = surface.height();
  // A crossing may round to one texel before its window; the window of an open map may begin before the map.
  const int widest = wrap ? 0 : window_size(kMipLevels - 1);
  HeightPlane plane;
  plane.margin_left = 1 + widest + (wrap ? 0 : kSliceLanes);
  plane.margin_above = 1 + widest;
  const int right = kReach, below = window_size(0) + 2;
  const int columns = plane.margin_left + width + right, rows = plane.margin_above + height + below;
  plane.pitch = static_cast<size_t>(columns);
  plane.values.resize(plane.pitch * static_cast<size_t>(rows));
  parallel_for(static_cast<size_t>(rows), kRowsPerPiece, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row) - plane.margin_above;
      float* values = plane.values.data() + row * plane.pitch;
      for (int x = -plane.margin_left; x < width + right; ++x) {
        const bool inside = x >= 0 && y >= 0 && x < width && y < height;
        const auto height_m = [&] { return surface.heights_m(wrap_index(x, width), wrap_index(y, height)); };
        // The same rounding to float as Embree's vertices.
        *values++ = wrap || inside ? static_cast<float>(height_m() / surface.texel_size_m) : kNoHeight;
      }
    }
  });
  return plane;
}

// Widens the window of every texel of `plane` by `step` texels to the right and downwards. wide: scratch.
void widen(const HeightPyramid& pyramid, int step, HeightPlane& plane, LargePageVector<float>& wide) {
  const size_t pitch = plane.pitch, rows = plane.values.size() / pitch, s = static_cast<size_t>(step);
  // Beyond the margin a wrapping map starts again (margins on the left and above are 1); an open one is
  // empty.
  const auto wrapped = [](size_t i, int period) { return (i - 1) % static_cast<size_t>(period) + 1; };
  wide.resize(plane.values.size());
  parallel_for(rows, kRowsPerPiece, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) {
      const float* from = plane.values.data() + y * pitch;
      float* to = wide.data() + y * pitch;
      const size_t inside = pitch > s ? pitch - s : 0;
      for (size_t x = 0; x < inside; ++x) to[x] = std::max(from[x], from[x + s]);
      for (size_t x = inside; x < pitch; ++x)
        to[x] = pyramid.wrap ? std::max(from[x], from[wrapped(x + s, pyramid.width)]) : from[x];
    }
  });
  parallel_for(rows, kRowsPerPiece, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) {
      const size_t other = y + s < rows ? y + s : pyramid.wrap ? wrapped(y + s, pyramid.height) : y;
      const float *here = wide.data() + y * pitch, *there = wide.data() + other * pitch;
      float* to = plane.values.data() + y * pitch;
      for (size_t x = 0; x < pitch; ++x) to[x] = std::max(here[x], there[x]);
    }
  });
}

// Returns the maxima over 2^row_shift rows, and over 2^column_shift columns with the lanes that start there.
HeightPlane max_pool(const HeightPlane& plane, int row_shift, int column_shift) {
  HeightPlane pooled;
  pooled.margin_left = plane.margin_left;
  pooled.margin_above = plane.margin_above;
  pooled.row_shift = row_shift;
  pooled.column_shift = column_shift;
  const size_t pitch = plane.pitch, rows = plane.values.size() / pitch;
  const size_t lanes = column_shift > 0 ? size_t{kSliceLanes} : 1;
  pooled.pitch = ((pitch - 1) >> column_shift) + 1;
  const size_t pooled_rows = ((rows - 1) >> row_shift) + 1;
  pooled.values.assign(pooled_rows * pooled.pitch, kNoHeight);
  parallel_for(pooled_rows, kRowsPerPiece, [&](size_t begin, size_t end) {
    std::vector<float> column_max(pitch);
    for (size_t row = begin; row < end; ++row) {
      std::fill(column_max.begin(), column_max.end(), kNoHeight);
      for (size_t y = row << row_shift; y < std::min(rows, (row + 1) << row_shift); ++y)
        for (size_t x = 0; x < pitch; ++x)
          column_max[x] = std::max(column_max[x], plane.values[y * pitch + x]);
      for (size_t column = 0; column < pooled.pitch; ++column) {
        const size_t first = column << column_shift, last = ((column + 1) << column_shift) + lanes - 1;
        pooled.values[row * pooled.pitch + column] =
            *std::max_element(column_max.begin() + static_cast<std::ptrdiff_t>(first),
                              column_max.begin() + static_cast<std::ptrdiff_t>(std::min(pitch, last)));
      }
    }
  });
  return pooled;
}

// Returns the plane in vertical strips.
HeightPlane cut_into_strips(const HeightPlane& plane) {
  const size_t width = size_t{1} << kStripShift, pitch = std::min(width + kReach, plane.pitch);
  const size_t rows = plane.values.size() / plane.pitch, strips = (plane.pitch + width - 1) / width;
  HeightPlane cut;
  cut.pitch = pitch;
  cut.strip_size = rows * pitch;
  cut.strip_shift = kStripShift;
  cut.margin_left = plane.margin_left;
  cut.margin_above = plane.margin_above;
  cut.row_shift = plane.row_shift;
  cut.values.resize(strips * cut.strip_size);
  parallel_for(rows, kRowsPerPiece, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row)
      for (size_t strip = 0; strip < strips; ++strip) {
        const size_t first = strip * width, there = std::min(pitch, plane.pitch - first);
        float* to = cut.values.data() + strip * cut.strip_size + row * pitch;
        std::copy_n(plane.values.data() + row * plane.pitch + first, there, to);
        std::fill(to + there, to + pitch, kNoHeight);  // never read
      }
  });
  return cut;
}

}  // namespace

HeightPyramid make_height_pyramid(const Surface& surface) {
  HeightPyramid pyramid;
  pyramid.width = surface.width();
  pyramid.height = surface.height();
  pyramid.inverse_width = 1.0 / pyramid.width;
  pyramid.inverse_height = 1.0 / pyramid.height;
  pyramid.wrap = surface.edge == Edge::kWrap;
  pyramid.ends_at_horizontal = surface.edge != Edge::kOpen;
  HeightPlane plane = margined_heights(surface, pyramid.wrap);
  pyramid.top = *std::max_element(plane.values.begin(), plane.values.end());
  pyramid.heights = cut_into_strips(plane);
  LargePageVector<float> wide;
  int size = 1;
  for (size_t level = 0; level < kMipLevels; ++level) {
    for (const int wanted = window_size(static_cast<int>(level)); size < wanted;) {
      const int step = std::min(size, wanted - size);
      widen(pyramid, step, plane, wide);
      size += step;
    }
    pyramid.max_mips[level] = max_pool(plane, kRowShift[level], kColumnShift[level]);
  }
  pyramid.max_mips[0] = cut_into_strips(pyramid.max_mips[0]);
  return pyramid;
}

}  // namespace hemibake
