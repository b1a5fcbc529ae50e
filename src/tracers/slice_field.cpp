#include "tracers/slice_field.h"

#include <algorithm>

#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr size_t kRowsPerPiece = 16;

int window_size(int level) { return kSegmentCells * kSkipSegments[level] + 2; }

// Widens the window of every place of `plane` by `step` texels to the right and downwards.
void widen(const SliceField& field, int step, std::vector<float>& plane) {
  const size_t pitch = field.pitch, rows = plane.size() / pitch;
  // Beyond the margin a wrapping map starts again; an open one has nothing.
  const auto beyond = [&](size_t i, int period) { return i - static_cast<size_t>(period) * ((i - 1) / period); };
  const size_t s = static_cast<size_t>(step);
  std::vector<float> wide(plane.size());
  parallel_for(rows, kRowsPerPiece, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) {
      const float* from = plane.data() + y * pitch;
      float* to = wide.data() + y * pitch;
      const size_t inside = pitch > s ? pitch - s : 0;
      for (size_t x = 0; x < inside; ++x) to[x] = std::max(from[x], from[x + s]);
      for (size_t x = inside; x < pitch; ++x)
        to[x] = field.wrap ? std::max(from[x], from[beyond(x + s, field.width)]) : from[x];
    }
  });
  parallel_for(rows, kRowsPerPiece, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) {
      const bool inside = y + s < rows;
      const size_t other = inside ? y + s : field.wrap ? beyond(y + s, field.height) : y;
      const float *here = wide.data() + y * pitch, *there = wide.data() + other * pitch;
      float* to = plane.data() + y * pitch;
      for (size_t x = 0; x < pitch; ++x) to[x] = std::max(here[x], there[x]);
    }
  });
}

}  // namespace

SliceField make_slice_field(const Surface& surface) {
  SliceField field;
  field.width = surface.width();
  field.height = surface.height();
  field.wrap = surface.edge == Edge::kWrap;
  // A crossing may round to one texel before its window; the window of an open map may begin before the map.
  field.margin_left = 1 + (field.wrap ? 0 : window_size(kSkipLevels - 1) + kSliceLanes);
  field.margin_above = 1 + (field.wrap ? 0 : window_size(kSkipLevels - 1));
  const int right = window_size(0) + 1 + kSliceLanes, below = window_size(0) + 1;
  const int columns = field.margin_left + field.width + right;
  const int rows = field.margin_above + field.height + below;
  field.pitch = static_cast<size_t>(columns);

  field.heights.resize(field.pitch * static_cast<size_t>(rows));
  parallel_for(static_cast<size_t>(rows), kRowsPerPiece, [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row) - field.margin_above;
      for (int x = -field.margin_left; x < field.width + right; ++x) {
        const bool inside = x >= 0 && y >= 0 && x < field.width && y < field.height;
        // The same rounding to float as Embree's vertices.
        field.heights[row * field.pitch + static_cast<size_t>(x + field.margin_left)] =
            field.wrap || inside
                ? static_cast<float>(surface.heights_m(wrap_index(x, field.width), wrap_index(y, field.height)) /
                                     surface.texel_size_m)
                : kNoHeight;
      }
    }
  });
  field.top = *std::max_element(field.heights.begin(), field.heights.end());

  std::vector<float> plane = field.heights;
  int size = 1;
  for (int level = 0; level < kSkipLevels; ++level) {
    for (const int wanted = window_size(level); size < wanted;) {
      const int step = std::min(size, wanted - size);
      widen(field, step, plane);
      size += step;
    }
    field.tallest[static_cast<size_t>(level)] = plane;
  }
  return field;
}

}  // namespace hemibake
