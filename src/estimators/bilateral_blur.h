// Blurs AO across pixels but not across edges of the geometry: spatial Gaussian times a range kernel of
// normal and depth, (N_i·N)₊ exp(−(d_i − d)²/2s), run along the rows and then along the columns although it
// is not separable (as the notes of CS562 do; Tomasi & Manduchi 1998 for the filter).
#pragma once

#include "core/grid.h"
#include "estimators/geometry_buffer.h"

namespace hemibake {

struct BlurOptions {
  int radius_pixels = 4;         // window of 2r + 1 pixels; its Gaussian has a deviation of r/2
  double depth_variance_m2 = 0;  // s; 0: a hundredth of the squared AO radius (0.01 m² for the usual 1 m)
};

enum class BlurAxis { kRows, kColumns };

// Blurs along one axis. Pixels without a surface keep their value and give none.
// values: one per pixel. depth_variance_m2: above 0.
Grid<float> bilateral_blur_pass(const Grid<float>& values, const GeometryBuffer& buffer, int radius_pixels,
                                double depth_variance_m2, BlurAxis axis);

}  // namespace hemibake
