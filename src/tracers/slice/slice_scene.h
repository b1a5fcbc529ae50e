// Holds what slices are traced in: the surface, its heights for packets, and the paths of all receivers.
#pragma once

#include "surface/patches.h"
#include "surface/surface.h"
#include "tracers/slice/families.h"
#include "tracers/slice/height_pyramid.h"
#include "tracers/slice/slice.h"

namespace hemibake {

struct SliceScene {
  const Surface& surface;
  SliceOptions options;
  PatchSet patch_set;
  HeightPyramid pyramid;
  SliceFamilies families;

  double max_distance_texels() const { return options.max_distance_m / surface.texel_size_m; }
};

}  // namespace hemibake
