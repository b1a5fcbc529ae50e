// Crops the outer ring of a bake, which only occludes (--margin).
#pragma once

#include "bake/bake.h"

namespace hemibake {

// Returns the inner part of a plane. margin: texels off every side, less than half of either.
template <class T>
Grid<T> crop_plane(const Grid<T>& plane, int margin) {
  if (plane.empty() || margin == 0) return plane;
  Grid<T> inner(plane.width - 2 * margin, plane.height - 2 * margin);
  for (int y = 0; y < inner.height; ++y)
    for (int x = 0; x < inner.width; ++x) inner(x, y) = plane(x + margin, y + margin);
  return inner;
}

// Crops all planes of a bake, and what it says of its texels. margin: as of crop_plane.
void crop_bake(int margin, BakeResult& result);

// Throws InputError where a margin leaves nothing of a map.
void check_margin(int margin, int width, int height);

}  // namespace hemibake
