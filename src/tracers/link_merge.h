// From hits to the links of a row.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "surface/surface.h"
#include "tracers/tracer.h"

namespace hemibake {

// Appends the links of a hit at `position` (texels, centres at integers, wrapped or clamped here) worth
// `weight`: the nearest texel.
void add_nearest_link(const Surface& surface, glm::dvec2 position, double weight,
                      std::vector<FormFactor>& links);

// The same, spread bilinearly over the four texels around it.
void add_bilinear_links(const Surface& surface, glm::dvec2 position, double weight,
                        std::vector<FormFactor>& links);

// The same at `uv` of a facet (surface/patches.h), for nodes on facets. A hit nearer than a quarter texel is
// linked to all nodes it lies between, in sixteenths, rounded by `choice`: few nodes are that near, so these
// links merge, and light in a deep fold finds its way out. A farther one is linked to one of them,
// drawn by `choice` in [0, 1).
void add_node_links(const PatchSet& patches, uint32_t facet, glm::dvec2 uv, double distance_texels,
                    double choice, double weight, std::vector<FormFactor>& links);

// Sorts links by patch and merges equal ones, weights summed in double in the order given.
void combine_links(std::vector<FormFactor>& links);

// combine_links of a row whose weights and direct_over_pi add up to 1. The rounding of the weights to float
// goes into the largest one, so that Σ weights + float(direct_over_pi) = 1 to the rounding of that one
// weight. A row without links is all sky: direct_over_pi becomes exactly 1.
void merge_links(Row& row);

}  // namespace hemibake
