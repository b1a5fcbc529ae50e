// Turns the hits of a receiver into the form factors of its row.
#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "surface/surface.h"
#include "tracers/ray_options.h"
#include "tracers/tracer.h"

namespace hemibake {

// A point of a facet that blocks part of a receiver's hemisphere.
struct FacetHit {
  uint32_t facet;
  glm::dvec2 uv;           // on the facet (surface/facets.h)
  double distance_texels;  // along the ray; infinity: draws one node however near it is
  double weight;           // share of the receiver's light, 0..1
};

// Appends the form factors of a hit, to nodes or texels as `patch_set` says.
// texel_links: how a hit is shared among texels. u: uniform in [0, 1), draws the node.
void add_form_factors(const Surface& surface, const PatchSet& patch_set, TexelLinks texel_links,
                      const FacetHit& hit, double u, std::vector<FormFactor>& form_factors);

// Appends the form factor of the texel nearest to a hit.
// position: in texels, centres at integers, wrapped or clamped here. weight: share of the light, 0..1.
void add_nearest_form_factor(const Surface& surface, glm::dvec2 position, double weight,
                             std::vector<FormFactor>& form_factors);

// Appends the form factors of the four texels around a hit, bilinear; parameters as of the nearest texel.
void add_bilinear_form_factors(const Surface& surface, glm::dvec2 position, double weight,
                               std::vector<FormFactor>& form_factors);

// Appends the form factors of nodes on the hit's facet. A hit nearer than a quarter texel is shared among the
// nodes around it, in sixteenths rounded by `u`: few nodes are that near, so these merge, and light in a deep
// fold finds its way out. A farther hit gives one node, drawn by `u` in [0, 1).
void add_node_form_factors(const PatchSet& patch_set, const FacetHit& hit, double u,
                           std::vector<FormFactor>& form_factors);

// Appends the form factor of a receiver to itself: of a texel to a patch at its centre, of a patch to that
// patch. receiver: a texel, or a patch where `is_patch`. weight: share of the light, 0..1.
void add_own_form_factor(const Surface& surface, const PatchSet& patch_set, uint32_t receiver, bool is_patch,
                         double weight, std::vector<FormFactor>& form_factors);

// Sorts form factors by patch and merges equal patches; weights are summed in double in the order given.
void merge_form_factors(std::vector<FormFactor>& form_factors);

// Merges a row whose weights and direct_over_pi add up to 1, and corrects the largest weight for rounding.
// Afterwards Σ weights + float(direct_over_pi) = 1 to the rounding of that one weight.
// A row without form factors is all sky: its direct_over_pi becomes exactly 1.
void complete_row(Row& row);

}  // namespace hemibake
