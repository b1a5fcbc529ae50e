// Views the surface by a camera: rays against its triangles (reference/ray_caster.h), traced once for any
// number of pictures of the view.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

struct CameraOptions {
  double azimuth_rad = 0.6;     // where the camera stands, seen from the middle of the map (lighting/sky.h)
  double elevation_rad = 0.75;  // above the ground, over 0 to π/2
  double field_of_view_rad = 0.5;  // across the picture
  double span = 1.1;               // map lengths across the picture at the middle of the map
  int width = 720, height = 540;   // pixels
  int samples = 3;                 // a side per pixel
};

// Holds where a camera ray meets the surface: shares of a facet's corners 1 and 2 (corner 0 has the rest).
struct ViewSample {
  static constexpr uint32_t kNothing = UINT32_MAX;
  uint32_t facet = kNothing;
  float u = 0, v = 0;
};

struct View {
  int width = 0, height = 0;
  int samples_per_pixel = 0;
  std::vector<ViewSample> samples;  // pixel by pixel
};

// Traces the camera rays. A wrapping map repeats for ever; beyond an open map is nothing, and the cut at its
// border has the colours of the border.
View trace_view(const Surface& surface, const CameraOptions& options);

// Paints the surface in the colours of its texels, interpolated over the triangles, over `background`.
Grid<glm::vec3> paint_view(const Surface& surface, const View& view, const Grid<glm::vec3>& texels,
                           const glm::vec3& background);

}  // namespace hemibake
