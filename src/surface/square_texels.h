// Resamples height maps whose texels are not square.
#pragma once

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

struct SquareTexels {
  Grid<float> heights;
  double texel_m = 1;  // the finer of the two spacings
  // Where the centre of the first texel lies, and how far apart centres are, in texels of the map given.
  double first_x = 0, first_y = 0, step_x = 1, step_y = 1;
};

// Resamples the coarser axis linearly to the spacing of the finer one; the surface along grid lines stays as
// it is. A wrapping map keeps its period, any other its first and last centres, each to the nearest whole
// number of texels. Throws InputError (without a file name) for spacings over 100 times apart and for a
// result of more than kMaxTexels. texel_x_m, texel_y_m: spacing of columns and rows, m.
SquareTexels make_texels_square(const Grid<float>& heights, double texel_x_m, double texel_y_m, Edge edge);

}  // namespace hemibake
