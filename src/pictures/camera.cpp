#include "pictures/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <optional>

#include "core/parallel.h"
#include "core/progress.h"
#include "lighting/sky.h"
#include "reference/ray_caster.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 8;  // rows

struct Camera {
  glm::dvec3 eye, right, down, forward;  // texels; orthonormal
  double pixel = 0;                      // side of a pixel at distance 1
};

Camera place_camera(const Surface& surface, const CameraOptions& options) {
  const double top = height_range_m(surface) / surface.texel_size_m;
  const double longer_side = std::max(surface.width(), surface.height());
  const glm::dvec3 towards_camera = direction_of(options.azimuth_rad, options.elevation_rad);
  Camera camera;
  camera.forward = -towards_camera;
  // Horizontal, to the right of who looks forward (y runs down the rows), also straight from above.
  camera.right = {-std::cos(options.azimuth_rad), -std::sin(options.azimuth_rad), 0};
  camera.down = glm::cross(camera.right, camera.forward);
  if (camera.down.z > 0) camera.down = -camera.down;
  const double half_tan = std::tan(options.field_of_view_rad / 2);
  // Far enough to take in the span, and above the highest texel.
  const double distance =
      std::max(options.span * longer_side / 2 / half_tan, 1.5 * top / std::sin(options.elevation_rad));
  const glm::dvec3 middle((surface.width() - 1) / 2.0, (surface.height() - 1) / 2.0, top / 2);
  camera.eye = middle + distance * towards_camera;
  camera.pixel = 2 * half_tan / options.width;
  return camera;
}

// Returns the point where the ray comes below the highest texel, inside the map.
std::optional<glm::dvec3> enter_relief(const Surface& surface, double top, const glm::dvec3& eye,
                                       const glm::dvec3& direction) {
  if (direction.z >= 0) return std::nullopt;
  double t = std::max(0.0, (top - eye.z) / direction.z);
  if (surface.edge == Edge::kWrap) {
    glm::dvec3 point = eye + t * direction;
    point.x -= surface.width() * std::floor(point.x / surface.width());
    point.y -= surface.height() * std::floor(point.y / surface.height());
    point.z = top;
    return point;
  }
  // Into the rectangle of an open map, where the ray comes into it above its ground.
  double leave = -eye.z / direction.z;
  const double last[] = {surface.width() - 1.0, surface.height() - 1.0};
  for (int k = 0; k < 2; ++k) {
    if (direction[k] == 0 && (eye[k] < 0 || eye[k] > last[k])) return std::nullopt;
    if (direction[k] == 0) continue;
    const double a = -eye[k] / direction[k], b = (last[k] - eye[k]) / direction[k];
    t = std::max(t, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (t > leave) return std::nullopt;
  glm::dvec3 point = eye + t * direction;
  point.x = std::clamp(point.x, 0.0, last[0]);
  point.y = std::clamp(point.y, 0.0, last[1]);
  return point;
}

ViewSample sample_at(const Surface& surface, const glm::dvec3& position) {
  const auto columns = static_cast<int>(facet_columns(surface));
  const auto rows = static_cast<int>(facet_count(surface) / 2) / columns;
  const int i = std::clamp(static_cast<int>(std::floor(position.x)), 0, columns - 1);
  const int j = std::clamp(static_cast<int>(std::floor(position.y)), 0, rows - 1);
  const double u = position.x - i, v = position.y - j;
  const auto cell = static_cast<uint32_t>(j) * static_cast<uint32_t>(columns) + static_cast<uint32_t>(i);
  if (u + v <= 1) return {2 * cell, static_cast<float>(u), static_cast<float>(v)};
  return {2 * cell + 1, static_cast<float>(1 - u), static_cast<float>(1 - v)};
}

}  // namespace

View trace_view(const Surface& surface, const CameraOptions& options) {
  const HeightFieldRayCaster caster(surface);
  const Camera camera = place_camera(surface, options);
  const double top = height_range_m(surface) / surface.texel_size_m;
  View view{options.width, options.height, options.samples * options.samples, {}};
  const auto per_row = static_cast<size_t>(view.width) * static_cast<size_t>(view.samples_per_pixel);
  view.samples.resize(per_row * static_cast<size_t>(view.height));
  Progress progress("looking", view.samples.size(), "ray");
  parallel_for(static_cast<size_t>(view.height), kGrain, [&](size_t begin, size_t end) {
    size_t next = begin * per_row;
    for (size_t y = begin; y < end; ++y)
      for (int x = 0; x < view.width; ++x)
        for (int s = 0; s < view.samples_per_pixel; ++s, ++next) {
          const double across = x + (s % options.samples + 0.5) / options.samples - view.width / 2.0;
          const double along =
              static_cast<double>(y) + (s / options.samples + 0.5) / options.samples - view.height / 2.0;
          const glm::dvec3 direction =
              glm::normalize(camera.forward + camera.pixel * (across * camera.right + along * camera.down));
          const auto start = enter_relief(surface, top, camera.eye, direction);
          SurfacePoint hit;
          if (start && caster.cast(*start, direction, hit) == RayOutcome::kHit)
            view.samples[next] = sample_at(surface, hit.position);
        }
    progress.advance((end - begin) * per_row);
  });
  return view;
}

Grid<glm::vec3> paint_view(const Surface& surface, const View& view, const Grid<glm::vec3>& texels,
                           const glm::vec3& background) {
  Grid<glm::vec3> picture(view.width, view.height);
  const auto per_pixel = static_cast<size_t>(view.samples_per_pixel);
  for (size_t pixel = 0; pixel < picture.size(); ++pixel) {
    glm::dvec3 sum(0);
    for (size_t s = pixel * per_pixel; s < (pixel + 1) * per_pixel; ++s) {
      const ViewSample& sample = view.samples[s];
      if (sample.facet == ViewSample::kNothing) {
        sum += glm::dvec3(background);
        continue;
      }
      const auto corners = facet_corners(surface, sample.facet).texel;
      const auto at = [&](int c) {
        return glm::dvec3(texels(corners[c].x % surface.width(), corners[c].y % surface.height()));
      };
      const double u = sample.u, v = sample.v;
      sum += (1 - u - v) * at(0) + u * at(1) + v * at(2);
    }
    picture[pixel] = glm::vec3(sum / static_cast<double>(per_pixel));
  }
  return picture;
}

}  // namespace hemibake
