#include "trade/resample.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "surface/normals.h"

namespace hemibake {
namespace {

// Bilinear at texel coordinates x, y (centres at whole numbers), beyond the border as `edge` says.
template <class T>
T interpolate(const Grid<T>& grid, double x, double y, Edge edge) {
  return interpolate_bilinear<float>(x, y, [&](int i, int j) {
    return grid(wrap_or_clamp(i, grid.width, edge), wrap_or_clamp(j, grid.height, edge));
  });
}

// grid, at the centres of width × height texels over the same ground.
template <class T>
Grid<T> resample(const Grid<T>& grid, int width, int height, Edge edge) {
  Grid<T> result(width, height);
  const double across = static_cast<double>(grid.width) / width,
               down = static_cast<double>(grid.height) / height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      result(x, y) = interpolate(grid, (x + 0.5) * across - 0.5, (y + 0.5) * down - 0.5, edge);
  return result;
}

}  // namespace

bool can_halve(const Surface& surface) {
  const int smallest = surface.edge != Edge::kWrap ? 4 : 2;  // open edges need two texels a side
  return surface.width() % 2 == 0 && surface.height() % 2 == 0 &&
         std::min(surface.width(), surface.height()) >= smallest;
}

Surface resample_surface(const Surface& surface, double factor) {
  const int width = static_cast<int>(std::lround(surface.width() * factor));
  const int height = static_cast<int>(std::lround(surface.height() * factor));
  Surface result;
  result.heights_m = resample(surface.heights_m, width, height, surface.edge);
  result.texel_size_m = surface.texel_size_m / factor;
  result.edge = surface.edge;
  // A surface's heights count from its lowest texel.
  const float lowest = *std::ranges::min_element(result.heights_m.values);
  for (float& h : result.heights_m.values) h -= lowest;
  if (surface.normals.values == central_difference_normals(surface).values) {
    result.normals = central_difference_normals(result);
  } else {
    result.normals = resample(surface.normals, width, height, surface.edge);
    for (glm::vec3& normal : result.normals.values) normal = glm::normalize(normal);
  }
  return result;
}

Grid<float> resample_plane(const Grid<float>& values, int width, int height, Edge edge) {
  return resample(values, width, height, edge);
}

}  // namespace hemibake
