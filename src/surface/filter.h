// Bilateral filter of a height map: smooths noise, keeps edges. The published experiment runs it before it
// marches (Mayaux 2018); Tomasi & Manduchi, "Bilateral Filtering for Gray and Color Images", ICCV 1998.
#pragma once

#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

// Which samples of the kernel are added up.
enum class FilterSum {
  kAll,
  // What the published shader adds up. It halves its kernel step by step, but the last step takes the first
  // four partial sums of a row where a 2 × 2 block is left: samples at odd row offsets are lost, and in every
  // fourth row those at column offsets 2 and 3 (modulo 4) count twice. At a radius of 1 texel that leaves the
  // texel itself, its right neighbour, and its left neighbour twice. The published curves show it
  // (tests/published/).
  kPublished,
};

struct FilterOptions {
  double radius = 1;       // texels, 0..16: three standard deviations of the domain weight; 0: no filter
  double tolerance = 0.2;  // standard deviation of the range weight, in units of `heights`, > 0
  FilterSum sum = FilterSum::kAll;
};

// Radius 1 texel, tolerance 0.2, summed as published.
FilterOptions published_filter();

// The mean of the heights around each texel, a neighbour at distance d and height difference Δh weighted by
// exp(−½ d²/(radius/3)²) · exp(−½ Δh²/tolerance²), out to 2 · radius (weight 2·10⁻⁸). Beyond an open edge is
// nothing. heights: finite height-map values, before make_surface. Throws InputError for options out of
// range.
Grid<float> bilateral_filter(const Grid<float>& heights, const FilterOptions& options, Edge edge);

}  // namespace hemibake
