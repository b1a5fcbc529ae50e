#include "surface/square_texels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace hemibake {
namespace {

constexpr double kFarthestApart = 100;

// Positions of new texels along one axis, in texels of the old.
struct Axis {
  int count;
  double first, step;
};

// texels: of the old axis. ratio: its spacing over the new one.
Axis resampled_axis(int texels, double ratio, Edge edge) {
  if (edge == Edge::kWrap) {
    const double count = std::max(1.0, std::round(texels * ratio));
    return {static_cast<int>(count), 0.5 * texels / count - 0.5, texels / count};
  }
  const double count = std::round((texels - 1) * ratio) + 1;
  return {static_cast<int>(count), 0, count > 1 ? (texels - 1) / (count - 1) : 1};
}

// Returns the value between two texels of a line.
template <class At>
float value_between(double position, int texels, Edge edge, const At& at) {
  const double below = std::floor(position);
  const int i = static_cast<int>(below);
  const double a = at(wrap_or_clamp(i, texels, edge)), b = at(wrap_or_clamp(i + 1, texels, edge));
  return static_cast<float>(a + (position - below) * (b - a));
}

}  // namespace

SquareTexels make_texels_square(const Grid<float>& heights, double texel_x_m, double texel_y_m, Edge edge) {
  SquareTexels square;
  square.texel_m = std::min(texel_x_m, texel_y_m);
  const double ratio = std::max(texel_x_m, texel_y_m) / square.texel_m;
  if (!(ratio <= kFarthestApart))
    throw InputError(fmt::format("texels of {:g} x {:g} m, expected spacings at most {} times apart",
                                 texel_x_m, texel_y_m, kFarthestApart));
  const bool wide = texel_x_m > texel_y_m;
  const int length = wide ? heights.width : heights.height, other = wide ? heights.height : heights.width;
  if (length * ratio * other > static_cast<double>(kMaxTexels))
    throw InputError(fmt::format("texels of {:g} x {:g} m would be {:.0f} square ones, expected at most {}",
                                 texel_x_m, texel_y_m, length * ratio * other, kMaxTexels));
  const Axis axis = resampled_axis(length, ratio, edge);
  (wide ? square.first_x : square.first_y) = axis.first;
  (wide ? square.step_x : square.step_y) = axis.step;
  square.heights = wide ? Grid<float>(axis.count, other) : Grid<float>(other, axis.count);
  for (int line = 0; line < other; ++line)
    for (int k = 0; k < axis.count; ++k) {
      const auto at = [&](int i) { return static_cast<double>(wide ? heights(i, line) : heights(line, i)); };
      const float value = value_between(axis.first + k * axis.step, length, edge, at);
      (wide ? square.heights(k, line) : square.heights(line, k)) = value;
    }
  return square;
}

}  // namespace hemibake
