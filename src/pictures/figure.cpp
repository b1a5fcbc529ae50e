#include "pictures/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "io/picture_text.h"

namespace hemibake {
namespace {

constexpr int kGap = 8;       // pixels between panels and around the figure
constexpr int kLetters = 14;  // size of captions
constexpr int kSmallLetters = 13;
constexpr int kBarHeight = 14;
constexpr glm::vec3 kInk{0.13f, 0.13f, 0.13f};

template <class T>
Grid<T> magnified(const Grid<T>& values, int factor) {
  Grid<T> large(values.width * factor, values.height * factor);
  for (int y = 0; y < large.height; ++y)
    for (int x = 0; x < large.width; ++x) large(x, y) = values(x / factor, y / factor);
  return large;
}

// Holds the shares of the rows (or columns) that a pixel of a reduced picture covers.
struct Cover {
  int first = 0;
  std::vector<double> shares;  // of first, first + 1, …; they sum to 1
};

std::vector<Cover> covers(int from, int to) {
  std::vector<Cover> result(static_cast<size_t>(to));
  const double size = static_cast<double>(from) / to;
  for (int k = 0; k < to; ++k) {
    const double begin = k * size, end = std::min<double>(from, (k + 1) * size);
    Cover& cover = result[static_cast<size_t>(k)];
    cover.first = static_cast<int>(begin);
    for (int i = cover.first; i < end; ++i)
      cover.shares.push_back((std::min(end, i + 1.0) - std::max(begin, static_cast<double>(i))) /
                             (end - begin));
  }
  return result;
}

// Returns the means over the area of each pixel. OpenImageIO's resize counts whole texels or blurs: it shifts
// them by up to half. Sum: T in double.
template <class Sum, class T>
Grid<T> reduced(const Grid<T>& values, int width, int height) {
  Grid<T> small(width, height);
  const std::vector<Cover> columns = covers(values.width, width), rows = covers(values.height, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Cover& across = columns[static_cast<size_t>(x)];
      const Cover& along = rows[static_cast<size_t>(y)];
      Sum sum(0);
      for (size_t j = 0; j < along.shares.size(); ++j)
        for (size_t i = 0; i < across.shares.size(); ++i)
          sum += along.shares[j] * across.shares[i] *
                 Sum(values(across.first + static_cast<int>(i), along.first + static_cast<int>(j)));
      small(x, y) = T(sum);
    }
  return small;
}

template <class Sum, class T>
Grid<T> scaled_to(const Grid<T>& values, int side) {
  const int longer = std::max(values.width, values.height);
  if (longer <= side) return side / longer > 1 ? magnified(values, side / longer) : values;
  const auto part = [&](int length) {
    return std::max(1, static_cast<int>(std::lround(static_cast<double>(length) * side / longer)));
  };
  return reduced<Sum>(values, part(values.width), part(values.height));
}

void paste(Grid<glm::vec3>& picture, const Grid<glm::vec3>& part, int x, int y) {
  for (int j = 0; j < part.height; ++j)
    std::copy_n(part.values.begin() + static_cast<std::ptrdiff_t>(part.index(0, j)), part.width,
                picture.values.begin() + static_cast<std::ptrdiff_t>(picture.index(x, y + j)));
}

// Returns the width of a panel with its caption.
int width_of(const Panel& panel) {
  return std::max(panel.shown.width, text_size(panel.caption, kLetters).width);
}

struct RowSize {
  int width = 0, height = 0;
  int caption = 0;  // height of the captions' line
};

RowSize size_of(const std::vector<Panel>& row) {
  RowSize size;
  for (const Panel& panel : row) {
    size.width += width_of(panel) + (size.width > 0 ? kGap : 0);
    size.height = std::max(size.height, panel.shown.height);
    if (!panel.caption.empty() && has_font()) size.caption = kLetters + kGap;
  }
  return size;
}

void write_tick(Grid<glm::vec3>& bar, const ColorScale& scale, double share) {
  const std::string text = fmt::format("{:.3g}", scale.low + share * (scale.high - scale.low));
  const int width = text_size(text, kSmallLetters).width;
  const int x =
      std::clamp(static_cast<int>(share * bar.width) - width / 2, 0, std::max(0, bar.width - width));
  draw_text(bar, x, kBarHeight + kSmallLetters + 3, text, kSmallLetters, kInk);
}

}  // namespace

Grid<glm::vec3> scaled(const Grid<glm::vec3>& linear, int side) {
  return scaled_to<glm::dvec3>(linear, side);
}
Grid<float> scaled(const Grid<float>& values, int side) { return scaled_to<double>(values, side); }

Grid<glm::vec3> colored(const Grid<float>& values, const ColorScale& scale, size_t& clipped) {
  Grid<glm::vec3> colors(values.width, values.height);
  for (size_t i = 0; i < values.size(); ++i) {
    const double share = (static_cast<double>(values[i]) - scale.low) / (scale.high - scale.low);
    clipped += share < -1e-6 || share > 1 + 1e-6;  // rounding of a float at an end is no clipping
    const glm::dvec3 linear = scale.map(scale.map_low + share * (1 - scale.map_low));
    for (int c = 0; c < 3; ++c) colors[i][c] = static_cast<float>(srgb_from_linear(linear[c]));
  }
  return colors;
}

Grid<glm::vec3> scale_bar(const ColorScale& scale, int width) {
  const int text_lines = !has_font() ? 0 : scale.label.empty() ? 1 : 2;
  Grid<glm::vec3> bar(width, kBarHeight + text_lines * (kSmallLetters + 6), kPaper);
  size_t clipped = 0;
  Grid<float> ramp(width, 1);
  for (int x = 0; x < width; ++x)
    ramp[static_cast<size_t>(x)] =
        static_cast<float>(scale.low + (x + 0.5) / width * (scale.high - scale.low));
  const Grid<glm::vec3> colors = colored(ramp, scale, clipped);
  for (int y = 0; y < kBarHeight; ++y) paste(bar, colors, 0, y);
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) write_tick(bar, scale, share);
  const int label_width = text_size(scale.label, kSmallLetters).width;
  draw_text(bar, std::max(0, (width - label_width) / 2), kBarHeight + 2 * kSmallLetters + 8, scale.label,
            kSmallLetters, kInk);
  return bar;
}

Grid<glm::vec3> make_figure(std::span<const std::vector<Panel>> rows,
                            std::span<const Grid<glm::vec3>> below) {
  int width = 0, height = kGap;
  for (const auto& row : rows) {
    const RowSize size = size_of(row);
    width = std::max(width, size.width);
    height += size.caption + size.height + kGap;
  }
  for (const auto& part : below) {
    width = std::max(width, part.width);
    height += part.height + kGap;
  }
  Grid<glm::vec3> figure(width + 2 * kGap, height, kPaper);
  int y = kGap;
  for (const auto& row : rows) {
    const RowSize size = size_of(row);
    int x = (figure.width - size.width) / 2;
    for (const Panel& panel : row) {
      draw_text(figure, x, y + kLetters, panel.caption, kLetters, kInk);
      paste(figure, panel.shown, x, y + size.caption);
      x += width_of(panel) + kGap;
    }
    y += size.caption + size.height + kGap;
  }
  for (const auto& part : below) {
    paste(figure, part, (figure.width - part.width) / 2, y);
    y += part.height + kGap;
  }
  return figure;
}

}  // namespace hemibake
