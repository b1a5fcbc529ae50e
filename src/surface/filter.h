// Smooths noise of a height map and keeps edges: bilateral filter (Tomasi, Manduchi, "Bilateral Filtering for
// Gray and Color Images", ICCV 1998). The experiment of Mayaux 2018 runs it before it marches.
#pragma once

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// Selects the samples of the kernel that are summed.
enum class FilterSum {
  kAll,
  // As the shader of 2018. It halves its kernel step by step, but the last step takes the first four partial
  // sums of a row instead of a 2 × 2 block: samples at odd row offsets are lost, and in every fourth row
  // those at column offsets 2 and 3 (modulo 4) count twice. At a radius of 1 texel that leaves the texel
  // itself, its right neighbour, and its left neighbour twice. The curves of 2018 show it (tests/published/).
  kMayaux2018,
};

struct FilterOptions {
  double radius = 1;       // texels, 0..16: three standard deviations of the domain weight; 0: no filter
  double tolerance = 0.2;  // standard deviation of the range weight, in units of `heights`, > 0
  FilterSum sum = FilterSum::kAll;
};

// Returns the settings of 2018: radius 1 texel, tolerance 0.2, kMayaux2018.
FilterOptions mayaux2018_filter();

// Returns the weighted mean of the heights around each texel: a neighbour at distance d with height
// difference Δh weighs exp(−½ d²/(radius/3)²) · exp(−½ Δh²/tolerance²), out to 2 · radius (weight 2·10⁻⁸).
// Beyond an open edge is nothing. heights: finite height-map values, before make_surface. Throws InputError
// for options out of range.
Grid<float> bilateral_filter(const Grid<float>& heights, const FilterOptions& options, Edge edge);

}  // namespace hemibake
