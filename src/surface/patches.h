// Patches re-emit light: nodes on every facet of the surface, or the texels themselves.
//
// Light varies along a facet, most of all along a long steep one, and a receiver sees the part next to it. So
// a facet is cut into k² equal triangles, light is known at their corners ("nodes") and linear between them:
// point collocation with linear elements (Cohen, Wallace, "Radiosity and Realistic Image Synthesis", 1993,
// chapter 3). Facets share no nodes, since light jumps where the normal does. Light between the nodes is
// their convex combination, so form factors are never negative and no light is made.
//
// k is 2, or 4 where the facet has an edge longer than 2 texels (surface/README.md: why).
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "surface/surface.h"

namespace hemibake {

enum class PatchKind { kFacets, kTexels };

inline constexpr int kCoarseSubdivision = 2, kFineSubdivision = 4;
inline constexpr double kLongestCoarseEdge = 2;  // texels
inline constexpr uint32_t kRunCells = 16;        // a run begins at multiples of this in a row of cells
inline constexpr uint32_t kTileRows = 16;        // a tile begins at multiples of this row of cells

// Returns the number of nodes of a facet cut into k² triangles.
constexpr uint32_t node_count(int k) { return static_cast<uint32_t>((k + 1) * (k + 2) / 2); }
inline constexpr uint32_t kCoarseNodes = node_count(kCoarseSubdivision),
                          kFineNodes = node_count(kFineSubdivision);

// The patches of a surface. Nodes are numbered run by run, in a run by half of the cell, then by node, then
// by cell: the same node of neighbouring facets comes one after the other, and can be traced together. Runs
// are numbered tile by tile, a tile being a run and those below it: neighbours on the map are neighbours in
// memory, and differences of patch indices within a tile are small.
struct PatchSet {
  PatchKind kind = PatchKind::kFacets;
  uint32_t count = 0;
  // kFacets only:
  uint32_t columns = 0;                       // cells in a row
  uint32_t cell_rows = 0;                     // rows of cells
  uint32_t runs_in_row = 0;                   // ⌈columns / kRunCells⌉
  std::vector<uint32_t> first;                // first patch of every run, and `count` at the end
  std::vector<std::array<uint16_t, 2>> fine;  // bits of every run's cells: facets of either half cut finely
};

// Makes the patches of a surface. Throws InputError for more than 2^31 of them.
PatchSet make_patches(const Surface& surface, PatchKind kind);

// A node of a facet. Nodes are numbered alike on all facets: first the six at the corners and the middles of
// the sides, row by row, then the nine more of a finely cut facet. Coordinates on a facet are barycentric: u
// of its corner 1, v of its corner 2 (surface/facets.h).
struct FacetNode {
  uint32_t facet;
  int subdivision;  // k
  uint32_t node;    // 0 … node_count(k) − 1
};
// Returns the coordinates of a node on its facet.
glm::dvec2 node_uv(uint32_t node);
// Returns the node at u = column/k, v = row/k.
uint32_t node_at(int k, int column, int row);
// Returns whether a node is a corner of its facet.
constexpr bool is_corner(uint32_t node) { return node == 0 || node == 2 || node == 5; }

// Sixteen neighbouring cells, or fewer at the end of a row.
struct PatchRun {
  uint32_t first;       // patch
  uint32_t first_cell;  // cells are numbered row by row
  uint32_t cells;
  std::array<uint16_t, 2> fine;  // as in PatchSet

  int subdivision(uint32_t half, uint32_t cell_in_run) const {
    return (fine[half] >> cell_in_run & 1) != 0 ? kFineSubdivision : kCoarseSubdivision;
  }
  // Returns the bits of the cells whose facets have this node.
  uint32_t cells_with(uint32_t half, uint32_t node) const {
    return node < kCoarseNodes ? (1u << cells) - 1 : fine[half];
  }
  uint32_t patch(uint32_t half, uint32_t node, uint32_t cell_in_run) const;
};
// Returns a run by its number.
PatchRun patch_run(const PatchSet& patch_set, uint32_t run);

// One node on all facets of a run that have it; its patches ascend by one from cell to cell.
struct NodeGroup {
  PatchRun run;
  uint32_t half, node;
  uint32_t first;  // patch
};
// Returns the group that a patch is in.
NodeGroup group_of_patch(const PatchSet& patch_set, uint32_t patch);

// Returns the node that a patch is.
FacetNode facet_node(const PatchSet& patch_set, uint32_t patch);

// Share of a patch in the light at a point of a facet.
struct PatchShare {
  uint32_t patch;
  double share;
};
// Returns the patches whose light makes up the light at `uv` of a facet; shares are not negative and sum
// to 1.
std::array<PatchShare, 3> patch_shares(const PatchSet& patch_set, uint32_t facet, glm::dvec2 uv);

// Returns one of patch_shares, drawn with its share by `u` in [0, 1).
uint32_t sample_patch(const PatchSet& patch_set, uint32_t facet, glm::dvec2 uv, double u);

// Returns a start of a node's rays: in a small copy of the facet at the node, since a point exactly on a
// corner belongs to all facets around it. point: on the facet, uniform.
glm::dvec2 node_start_uv(uint32_t node, glm::dvec2 point);

// Returns the weight of a node in the mean over its facet's area; weights sum to 1 over the nodes. The rule
// for quadratic elements on a coarsely cut facet; on a finely cut one, a quarter of it and three quarters of
// the rule for linear ones, since light is darkest along the folds of the surface.
double node_area_share(int k, uint32_t node);

// Returns the area that a node stands for, texels².
double patch_area_texels(const Surface& surface, const PatchSet& patch_set, uint32_t patch);

// Returns the position of a patch in texels, texel centres at integers, not wrapped.
glm::dvec2 patch_position_texels(const Surface& surface, const PatchSet& patch_set, uint32_t patch);

}  // namespace hemibake
