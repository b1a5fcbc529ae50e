#include "surface/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "surface/normals.h"

namespace hemibake {
namespace {

constexpr double kMinSizeM = 1e-12, kMaxSizeM = 1e12;
// Squares of slopes, and the z of a normal, stay far inside the range of a float.
constexpr double kMaxRangeTexels = 1e12;

}  // namespace

Surface make_surface(Grid<float> heights, double size_m, double amplitude_m, Edge edge) {
  if (heights.empty()) throw InputError("the map has no texels, expected at least one");
  if (heights.size() > kMaxTexels)
    throw InputError(fmt::format("the map has {} texels, expected at most {}", heights.size(), kMaxTexels));
  if (edge != Edge::kWrap && (heights.width < 2 || heights.height < 2))
    throw InputError(
        fmt::format("{}x{} texels span no surface with open edges, expected at least 2x2 (or wrapping edges)",
                    heights.width, heights.height));
  if (!(size_m >= kMinSizeM && size_m <= kMaxSizeM))
    throw InputError(fmt::format("size {} m, expected {} to {} m", size_m, kMinSizeM, kMaxSizeM));
  if (!(amplitude_m >= 0) || !std::isfinite(amplitude_m))
    throw InputError(fmt::format("amplitude {} m, expected a finite length of 0 or more", amplitude_m));
  for (size_t i = 0; i < heights.size(); ++i)
    if (!std::isfinite(heights[i]))
      throw InputError(fmt::format("height at texel {},{} is {}, expected a finite number",
                                   i % static_cast<size_t>(heights.width),
                                   i / static_cast<size_t>(heights.width), heights[i]));

  Surface surface;
  surface.texel_size_m = size_m / std::max(heights.width, heights.height);
  surface.edge = edge;
  // The lowest texel becomes height 0, in double, so that an offset costs no precision.
  const double lowest = *std::min_element(heights.values.begin(), heights.values.end());
  for (float& height : heights.values) {
    const double metres = (static_cast<double>(height) - lowest) * amplitude_m;
    if (metres > kMaxRangeTexels * surface.texel_size_m)
      throw InputError(
          fmt::format("height range of {} m over texels of {} m, expected at most {} times a texel", metres,
                      surface.texel_size_m, kMaxRangeTexels));
    height = static_cast<float>(metres);
  }
  surface.heights_m = std::move(heights);
  surface.normals = central_difference_normals(surface);
  return surface;
}

double height_range_m(const Surface& surface) {
  const auto [low, high] =
      std::minmax_element(surface.heights_m.values.begin(), surface.heights_m.values.end());
  return static_cast<double>(*high) - static_cast<double>(*low);
}

glm::dvec3 texel_position_texels(const Surface& surface, uint32_t texel) {
  const auto width = static_cast<uint32_t>(surface.width());
  return {texel % width, texel / width, surface.heights_m[texel] / surface.texel_size_m};
}

}  // namespace hemibake
