// Fills texels of a height map that have no height.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// Fills every hole with the membrane over its rim: Laplace's equation, so no value lies beyond the rim's, and
// a slope across the hole goes on. Towards an open border the membrane is free. Returns the number of holes
// filled. Throws InputError (without a file name) where no texel has a height.
// holes: of the size of `heights`, 1: no height there; empty: none.
size_t fill_holes(const Grid<uint8_t>& holes, Edge edge, Grid<float>& heights);

}  // namespace hemibake
