// Where light is known on the surface and sent on from: nodes on every facet, or the texels themselves.
//
// Light varies along a facet, most of all along a long steep one, and a receiver sees the part next to it:
// one value per facet leaves the first bounce of rough maps 5 % too bright (FACTS.md §4). So a facet is cut
// into k² equal triangles, light is known at their corners ("nodes") and linear between them: point
// collocation with linear elements (Cohen, Wallace, "Radiosity and Realistic Image Synthesis", 1993, chapter
// 3). Facets share no nodes, since light jumps where the normal does. What lies between the nodes is a convex
// combination of them, so links are never negative and no light is made.
//
// k is 2, or 4 where the facet has an edge longer than 2 texels. Measured against the referee
// (fits/README.md): k = 1 leaves the first bounce 1 to 2 % off on rough maps, k = 6 brings no more than 0.1 %
// over k = 4.
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

// Nodes of a facet cut into k² triangles.
constexpr uint32_t node_count(int k) { return static_cast<uint32_t>((k + 1) * (k + 2) / 2); }
inline constexpr uint32_t kCoarseNodes = node_count(kCoarseSubdivision),
                          kFineNodes = node_count(kFineSubdivision);

// Patches that are nodes are numbered run by run, in a run by half of the cell, then by node, then by cell:
// the same node of neighbouring facets comes one after the other, and can be traced together. Runs are
// numbered tile by tile, a tile being a run and those below it: what is near on the map is near in memory
// too, and links within a tile are short.
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

PatchSet make_patches(const Surface& surface, PatchKind kind);

// Nodes are numbered alike on all facets: first the six at the corners and the middles of the sides, row by
// row, then the nine more of a finely cut facet. Coordinates on a facet are barycentric: u of its corner 1, v
// of its corner 2 (surface/facets.h).
struct FacetNode {
  uint32_t facet;
  int subdivision;  // k
  uint32_t node;    // 0 … node_count(k) − 1
};
glm::dvec2 node_uv(uint32_t node);
// The node at u = column/k, v = row/k.
uint32_t node_at(int k, int column, int row);
// Whether it is a corner of its facet.
constexpr bool is_corner(uint32_t node) { return node == 0 || node == 2 || node == 5; }

// Sixteen neighbours, or what is left of them at the end of a row.
struct PatchRun {
  uint32_t first;       // patch
  uint32_t first_cell;  // cells are numbered row by row
  uint32_t cells;
  std::array<uint16_t, 2> fine;  // as in PatchSet

  int subdivision(uint32_t half, uint32_t cell_in_run) const {
    return (fine[half] >> cell_in_run & 1) != 0 ? kFineSubdivision : kCoarseSubdivision;
  }
  // Bits of the cells whose facets have this node.
  uint32_t cells_with(uint32_t half, uint32_t node) const {
    return node < kCoarseNodes ? (1u << cells) - 1 : fine[half];
  }
  uint32_t patch(uint32_t half, uint32_t node, uint32_t cell_in_run) const;
};
PatchRun patch_run(const PatchSet& patches, uint32_t run);

// The same node of the facets of a run that have it: their patches ascend by one from cell to cell.
struct NodeGroup {
  PatchRun run;
  uint32_t half, node;
  uint32_t first;  // patch
};
NodeGroup group_of_patch(const PatchSet& patches, uint32_t patch);

FacetNode facet_node(const PatchSet& patches, uint32_t patch);

// The patches whose light makes up the light at `uv` of a facet, with their shares: not negative, sum 1.
struct PatchShare {
  uint32_t patch;
  double share;
};
std::array<PatchShare, 3> patch_shares(const PatchSet& patches, uint32_t facet, glm::dvec2 uv);

// One of them, drawn with its share by `choice` in [0, 1): over many hits the same as a link to each, at a
// third of the links.
uint32_t sample_patch(const PatchSet& patches, uint32_t facet, glm::dvec2 uv, double choice);

// Where on its facet a node looks from: in a small copy of the facet at the node. A point exactly on a corner
// belongs to all facets around it, and what it sees depends on whose it is. point: on the facet, uniform.
glm::dvec2 node_start_uv(uint32_t node, glm::dvec2 point);

// Weight of a node in the mean over its facet's area; adds up to 1 over the nodes: the rule for quadratic
// elements on a coarsely cut facet, three quarters of the rule for linear ones on a finely cut one. Light is
// darkest along the folds of the surface; measured so, the mean of E₀ is off by 0.1 % or less.
double node_area_share(int k, uint32_t node);

// Area a node stands for, texels².
double patch_area_texels(const Surface& surface, const PatchSet& patches, uint32_t patch);

// Position of a patch in texels, texel centres at integers, not wrapped.
glm::dvec2 patch_position_texels(const Surface& surface, const PatchSet& patches, uint32_t patch);

}  // namespace hemibake
