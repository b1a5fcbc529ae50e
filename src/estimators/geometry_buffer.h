// Renders position, normal and depth of the surface per pixel: the input of screen-space methods.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

struct GeometryPixel {
  glm::dvec3 position_m;  // world
  glm::dvec3 normal;      // unit: the texels' shading normals, interpolated
  double depth_m;         // along the view direction; infinity where there is no surface
};

struct GeometryBuffer {
  Grid<GeometryPixel> pixels;
  double pixels_per_metre = 1;  // at depth 1 m in perspective, at every depth from straight above
  bool perspective = false;
  glm::dvec2 period_m{0};  // of a map that repeats beyond the borders of the picture; 0: nothing there

  // Returns the pixels that a length of 1 m spans at this depth.
  double scale_at(double depth_m) const {
    return perspective ? pixels_per_metre / depth_m : pixels_per_metre;
  }

  // Returns the pixel x, y, of a repeating map also outside the picture; nullopt without a surface.
  std::optional<GeometryPixel> read(int x, int y) const;
};

// Renders the surface from straight above, exactly a pixel per texel. camera_height_m: of the camera plane
// above the highest texel.
GeometryBuffer orthographic_buffer(const Surface& surface, double camera_height_m);

struct PerspectiveCamera {
  double tilt_rad = 0.5;           // from straight above towards the lower edge of the map, 0..1.4
  double field_of_view_rad = 0.8;  // across the picture, 0.1..2
  int pixels = 0;                  // sides of the picture; 0: as many as the map's longer side has texels
};

// A camera placed so that the sphere around the map fills the picture.
struct CameraView {
  glm::dvec3 eye_m;
  glm::dvec3 right, down, forward;  // orthonormal
  double focal_pixels;
  double center_pixels;

  // Returns pixel x, y (centres at whole numbers and a half) and depth of a point.
  glm::dvec3 project(const glm::dvec3& position_m) const;
};
// Places the camera.
CameraView camera_view(const Surface& surface, const PerspectiveCamera& camera);

// Renders the nearest facet in every pixel; a wrapping map is drawn with its eight neighbours.
GeometryBuffer perspective_buffer(const Surface& surface, const PerspectiveCamera& camera);

}  // namespace hemibake
