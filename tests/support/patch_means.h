// Means over the area of a surface.
#pragma once

#include <span>

#include "surface/facets.h"
#include "surface/patches.h"

namespace hemibake {

// Σ area · value over the patches, over the area of the map seen from above: for E₀/π of a tiled map, 1.
template <class Value>
double sum_over_opening(const Surface& surface, const PatchSet& patches, std::span<const Value> values) {
  double sum = 0;
  for (uint32_t patch = 0; patch < patches.count; ++patch)
    sum += patch_area_texels(surface, patches, patch) * static_cast<double>(values[patch]);
  return sum / (0.5 * facet_count(surface));
}

// Σ area · value / Σ area.
template <class Value>
double area_mean(const Surface& surface, const PatchSet& patches, std::span<const Value> values) {
  return sum_over_opening(surface, patches, values) /
         sum_over_opening(surface, patches, std::span<const Value>(std::vector<Value>(patches.count, 1)));
}

}  // namespace hemibake
