// Where light is known on the surface and sent on from: nodes on every facet, or the texels themselves.
//
// Light varies along a facet, most of all along a long steep one, and a receiver sees the part next to it:
// one value per facet leaves the first bounce of rough maps 5 % too bright (FACTS.md §4). So a facet is cut
// into k² equal triangles, k growing with its longest edge, light is known at their corners ("nodes") and
// linear between them: point collocation with linear elements (Cohen, Wallace, "Radiosity and Realistic Image
// Synthesis", 1993, chapter 3). Facets share no nodes, since light jumps where the normal does. The values
// between the nodes are convex combinations of theirs, so links are never negative and no light is made.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "surface/surface.h"

namespace hemibake {

enum class Patches { kFacets, kTexels };

// Coordinates on a facet are barycentric: u of its corner 1, v of its corner 2 (surface/facets.h).
struct PatchSet {
  Patches kind = Patches::kFacets;
  uint32_t count = 0;
  // kFacets only: first patch of every facet, and `count` at the end. Nodes row by row: those of v = 0 by
  // ascending u, then those of v = 1/k, ….
  std::vector<uint32_t> first;
};

// Edges longer than this many texels are cut.
inline constexpr double kLongestPatchEdge = 1.5;
inline constexpr int kMaxSubdivision = 6;

PatchSet make_patches(const Surface& surface, Patches kind);

// Nodes of a facet cut into k² triangles, and k from the number of nodes.
constexpr uint32_t node_count(int k) { return static_cast<uint32_t>((k + 1) * (k + 2) / 2); }
int subdivision(const PatchSet& patches, uint32_t facet);

struct FacetNode {
  uint32_t facet;
  int subdivision;  // k
  glm::dvec2 uv;
};
// Where patch `patch` of a set of nodes is.
FacetNode facet_node(const PatchSet& patches, uint32_t patch);

// One of the up to three patches whose light makes up the light at `uv` of a facet, drawn with their share by
// `choice` in [0, 1): over many hits the same as a link to each, at a third of the links.
uint32_t draw_patch(const PatchSet& patches, uint32_t facet, glm::dvec2 uv, double choice);

// Share of a facet's area a node stands for: ∫ of its linear element; adds up to 1 over the nodes.
double node_area_share(const FacetNode& node);

// Position of a patch in texels, texel centres at integers, not wrapped.
glm::dvec2 patch_position_texels(const Surface& surface, const PatchSet& patches, uint32_t patch);

}  // namespace hemibake
