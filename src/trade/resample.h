// Resamples a map to other texels: what a bake at half or double resolution answers for the texels of this
// one.
#pragma once

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// Both sides are even: half a map has whole texels.
bool can_halve(const Surface& surface);

// Twice (factor 2) or half (factor 0.5, needs can_halve) as many texels a side over the same ground. Heights
// are interpolated bilinearly at the new centres (at half resolution the mean of four). Normals: central
// differences of the new heights where the surface has its own, interpolated else.
Surface resample_surface(const Surface& surface, double factor);

// `values` of a resampled surface at the centres of the width × height texels it was made from, bilinearly.
Grid<float> resample_plane(const Grid<float>& values, int width, int height, Edge edge);

}  // namespace hemibake
