#include "estimators/geometry_buffer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "surface/facets.h"

namespace hemibake {
namespace {

constexpr double kNoSurface = std::numeric_limits<double>::infinity();

struct Corner {
  glm::dvec3 position_m;
  glm::dvec3 normal;
  glm::dvec3 projected;  // pixel x, pixel y, depth
};

double edge_function(const glm::dvec3& a, const glm::dvec3& b, double x, double y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

// Pixels from first to last.
struct PixelRange {
  int first, last;
};
// Returns the pixels whose centres lie between low and high.
PixelRange pixels_between(double low, double high, int count) {
  return {static_cast<int>(std::ceil(std::clamp(low - 0.5, 0.0, count * 1.0))),
          static_cast<int>(std::floor(std::clamp(high - 0.5, -1.0, count - 1.0)))};
}

// Draws one triangle with perspective-correct interpolation, nearest depth first.
void draw_triangle(const std::array<Corner, 3>& corners, Grid<GeometryPixel>& pixels) {
  const auto& [a, b, c] = corners;
  const double area = edge_function(a.projected, b.projected, c.projected.x, c.projected.y);
  if (area == 0) return;
  const auto [left, right] = std::minmax({a.projected.x, b.projected.x, c.projected.x});
  const auto [top, bottom] = std::minmax({a.projected.y, b.projected.y, c.projected.y});
  const PixelRange columns = pixels_between(left, right, pixels.width);
  const PixelRange rows = pixels_between(top, bottom, pixels.height);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      glm::dvec3 weight(edge_function(b.projected, c.projected, x + 0.5, y + 0.5),
                        edge_function(c.projected, a.projected, x + 0.5, y + 0.5),
                        edge_function(a.projected, b.projected, x + 0.5, y + 0.5));
      weight /= area;
      if (weight.x < 0 || weight.y < 0 || weight.z < 0) continue;
      weight /= glm::dvec3(a.projected.z, b.projected.z, c.projected.z);
      const double depth = 1 / (weight.x + weight.y + weight.z);
      if (!(depth < pixels(x, y).depth_m)) continue;
      weight *= depth;
      const glm::dvec3 normal = weight.x * a.normal + weight.y * b.normal + weight.z * c.normal;
      pixels(x, y) = {weight.x * a.position_m + weight.y * b.position_m + weight.z * c.position_m,
                      glm::normalize(normal), depth};
    }
  }
}

}  // namespace

std::optional<GeometryPixel> GeometryBuffer::read(int x, int y) const {
  const bool outside = x < 0 || y < 0 || x >= pixels.width || y >= pixels.height;
  if (outside && period_m.x == 0) return std::nullopt;
  const int inside_x = wrap_index(x, pixels.width), inside_y = wrap_index(y, pixels.height);
  GeometryPixel pixel = pixels(inside_x, inside_y);
  if (pixel.depth_m == kNoSurface) return std::nullopt;
  if (outside) {
    pixel.position_m.x += period_m.x * ((x - inside_x) / pixels.width);
    pixel.position_m.y += period_m.y * ((y - inside_y) / pixels.height);
  }
  return pixel;
}

GeometryBuffer orthographic_buffer(const Surface& surface, double camera_height_m) {
  GeometryBuffer buffer;
  const double t = surface.texel_size_m, top_m = height_range_m(surface);
  buffer.pixels = Grid<GeometryPixel>(surface.width(), surface.height());
  buffer.pixels_per_metre = 1 / t;
  if (surface.edge == Edge::kWrap) buffer.period_m = {t * surface.width(), t * surface.height()};
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const double height_m = surface.heights_m(x, y);
      buffer.pixels(x, y) = {glm::dvec3((x + 0.5) * t, (y + 0.5) * t, height_m),
                             glm::dvec3(surface.normals(x, y)), camera_height_m + top_m - height_m};
    }
  }
  return buffer;
}

glm::dvec3 CameraView::project(const glm::dvec3& position_m) const {
  const glm::dvec3 v = position_m - eye_m;
  const double depth = glm::dot(v, forward);
  return {center_pixels + focal_pixels * glm::dot(v, right) / depth,
          center_pixels + focal_pixels * glm::dot(v, down) / depth, depth};
}

CameraView camera_view(const Surface& surface, const PerspectiveCamera& camera) {
  const int pixels = camera.pixels > 0 ? camera.pixels : std::max(surface.width(), surface.height());
  const glm::dvec3 size_m(surface.width() * surface.texel_size_m, surface.height() * surface.texel_size_m,
                          height_range_m(surface));
  const double c = std::cos(camera.tilt_rad), s = std::sin(camera.tilt_rad);
  CameraView view;
  view.right = {1, 0, 0};
  view.down = {0, c, -s};
  view.forward = {0, -s, -c};
  view.eye_m =
      0.5 * size_m - 0.5 * glm::length(size_m) / std::sin(camera.field_of_view_rad / 2) * view.forward;
  view.center_pixels = 0.5 * pixels;
  view.focal_pixels = view.center_pixels / std::tan(camera.field_of_view_rad / 2);
  return view;
}

GeometryBuffer perspective_buffer(const Surface& surface, const PerspectiveCamera& camera) {
  const CameraView view = camera_view(surface, camera);
  const int side = static_cast<int>(2 * view.center_pixels);
  GeometryBuffer buffer;
  buffer.perspective = true;
  buffer.pixels_per_metre = view.focal_pixels;
  buffer.pixels = Grid<GeometryPixel>(side, side, {glm::dvec3(0), glm::dvec3(0, 0, 1), kNoSurface});

  const int copies = surface.edge == Edge::kWrap ? 1 : 0;
  const double t = surface.texel_size_m;
  for (int copy_y = -copies; copy_y <= copies; ++copy_y) {
    for (int copy_x = -copies; copy_x <= copies; ++copy_x) {
      for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
        const auto texels = facet_corners(surface, facet).texel;
        std::array<Corner, 3> corners;
        bool in_front = true;
        for (size_t i = 0; i < 3; ++i) {
          const int x = texels[i].x % surface.width(), y = texels[i].y % surface.height();
          corners[i].position_m = {(texels[i].x + copy_x * surface.width() + 0.5) * t,
                                   (texels[i].y + copy_y * surface.height() + 0.5) * t,
                                   surface.heights_m(x, y)};
          corners[i].normal = glm::dvec3(surface.normals(x, y));
          corners[i].projected = view.project(corners[i].position_m);
          in_front = in_front && corners[i].projected.z > 0;
        }
        if (in_front) draw_triangle(corners, buffer.pixels);
      }
    }
  }
  return buffer;
}

}  // namespace hemibake
