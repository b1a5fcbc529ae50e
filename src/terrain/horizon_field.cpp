#include "terrain/horizon_field.h"

#include <algorithm>
#include <bit>

#include "core/parallel.h"

namespace hemibake {

HorizonField::HorizonField(const Surface& surface, bool inverted)
    : width(surface.width()),
      height(surface.height()),
      edge(surface.edge),
      heights(surface.width() + 2 * kMargin, surface.height() + 2 * kMargin),
      top(kNoHeight) {
  const double scale = (inverted ? -1 : 1) / surface.texel_size_m;
  parallel_for(static_cast<size_t>(heights.height), 16, [&](size_t begin, size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      for (int u = 0; u < heights.width; ++u) {
        int x = u - kMargin, y = v - kMargin;
        const bool inside = x >= 0 && y >= 0 && x < width && y < height;
        if (!inside && edge != Edge::kWrap) {
          heights(u, v) = kNoHeight;
          continue;
        }
        if (!inside) {
          x = wrap_index(x, width);
          y = wrap_index(y, height);
        }
        heights(u, v) = static_cast<float>(scale * static_cast<double>(surface.heights_m(x, y)));
      }
  });
  top = *std::ranges::max_element(heights.values);
}

Grid<float> block_maxima(const HorizonField& field, int block) {
  Grid<float> maxima((field.width + block - 1) / block, (field.height + block - 1) / block);
  parallel_for(static_cast<size_t>(maxima.height), 1, [&](size_t begin, size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      for (int u = 0; u < maxima.width; ++u) {
        float most = kNoHeight;
        const int end_x = std::min(field.width, (u + 1) * block),
                  end_y = std::min(field.height, (v + 1) * block);
        for (int y = v * block; y < end_y; ++y)
          most = std::max(most, *std::max_element(field.at(u * block, y), field.at(end_x, y)));
        maxima(u, v) = most;
      }
  });
  return maxima;
}

WindowMaxima::WindowMaxima(const HorizonField& field, const Grid<float>& blocks, int block, int size_x,
                           int size_y)
    : shift_(std::countr_zero(static_cast<unsigned>(block))) {
  const bool wrap = field.edge == Edge::kWrap;
  // From any texel of a block on; where the map wraps, its last block may be a partial one.
  const auto count_of = [&](int size) { return (size + block - 2) / block + 1 + (wrap ? 1 : 0); };
  const int count_x = count_of(size_x), count_y = count_of(size_y);
  first_x_ = wrap ? 0 : 1 - count_x;
  first_y_ = wrap ? 0 : 1 - count_y;
  Grid<float> rows(blocks.width - first_x_, blocks.height, kNoHeight);
  maxima_ = Grid<float>(rows.width, blocks.height - first_y_, kNoHeight);
  parallel_for(static_cast<size_t>(rows.height), 8, [&](size_t begin, size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      for (int k = 0; k < std::min(count_x, wrap ? blocks.width : count_x); ++k)
        for (int u = 0; u < rows.width; ++u) {
          const int at = u + first_x_ + k, from = wrap && at >= blocks.width ? at - blocks.width : at;
          if (from >= 0 && from < blocks.width) rows(u, v) = std::max(rows(u, v), blocks(from, v));
        }
  });
  parallel_for(static_cast<size_t>(maxima_.height), 8, [&](size_t begin, size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      for (int k = 0; k < std::min(count_y, wrap ? blocks.height : count_y); ++k) {
        const int at = v + first_y_ + k, from = wrap && at >= blocks.height ? at - blocks.height : at;
        if (from < 0 || from >= blocks.height) continue;
        for (int u = 0; u < rows.width; ++u) maxima_(u, v) = std::max(maxima_(u, v), rows(u, from));
      }
  });
}

}  // namespace hemibake
