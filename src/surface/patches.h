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

#include "surface/node_sites.h"
#include "surface/surface.h"

namespace hemibake {

enum class PatchKind { kFacets, kTexels };

inline constexpr int kCoarseSubdivision = 2, kFineSubdivision = 4;
inline constexpr double kLongestCoarseEdge = 2;  // texels
inline constexpr uint32_t kRunTexels = 16;       // a run begins at multiples of this in a row of texels
inline constexpr uint32_t kTileRows = 16;        // a tile begins at multiples of this row of texels

// Returns the number of nodes of a facet cut into k² triangles.
constexpr uint32_t node_count(int k) { return static_cast<uint32_t>((k + 1) * (k + 2) / 2); }
inline constexpr uint32_t kCoarseNodes = node_count(kCoarseSubdivision);
static_assert(kFineNodes == node_count(kFineSubdivision));

// The facets around a texel on whose finer nodes' sites others stand: both halves of its cell, and the second
// half of the cells left of it and above it.
enum FineFacet : uint8_t { kFirstHalf, kSecondHalf, kLeftOfTexel, kAboveTexel };

// First patch of sixteen neighbouring texels, and by FineFacet which of their facets are cut finely.
struct StoredRun {
  uint32_t first;
  std::array<uint16_t, 4> fine;       // bits of texels
  std::array<uint8_t, 4> fine_count;  // of these bits
};

// The patches of a surface. Nodes are numbered run by run, in a run by slot (surface/node_sites.h), then by
// texel: nodes that stand at the same place, and the same node of neighbouring texels, come one after the
// other and can be traced together. Runs are numbered tile by tile, a tile being a run and those below it:
// neighbours on the map are neighbours in memory, and differences of patch indices within a tile are small.
struct PatchSet {
  PatchKind kind = PatchKind::kFacets;
  uint32_t count = 0;
  // kFacets only:
  uint32_t columns = 0, cell_rows = 0;  // cells
  double inverse_columns = 0;           // 1 / columns
  uint32_t width = 0, height = 0;       // texels
  uint32_t runs_in_row = 0;             // ⌈width / kRunTexels⌉
  std::vector<StoredRun> runs;          // and one that begins at `count`
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

// Returns the k of a facet.
int subdivision(const PatchSet& patch_set, uint32_t facet);

// Returns the patch of a node of a facet. node: below node_count(k).
uint32_t patch_at(const PatchSet& patch_set, uint32_t facet, uint32_t node);

// Returns the node that a patch is.
FacetNode facet_node(const PatchSet& patch_set, uint32_t patch);

// Sixteen neighbouring texels, or fewer at the end of a row, with the nodes that stand at them.
struct PatchRun {
  uint32_t first;  // patch
  uint32_t x, y;   // of the first texel
  uint32_t texels;
  bool whole;                     // all cells around its texels exist
  std::array<uint16_t, 4> cells;  // bits of texels: the cell `left` + 2 `up` before their own exists
  std::array<uint16_t, 4> fine;   // as in StoredRun
  std::array<uint8_t, 4> fine_count;

  // Returns the bits of the texels that have a slot's node.
  uint32_t texels_with(uint32_t slot) const;
  // Returns the first patch of a slot; of kSlots: the first of the next run.
  uint32_t first_of(uint32_t slot) const;
};
// Returns the run that a patch is in.
PatchRun run_of_patch(const PatchSet& patch_set, uint32_t patch);

// Returns the facet that a slot's node of a texel is on. x, y: texel.
uint32_t facet_of_slot(const PatchSet& patch_set, uint32_t slot, uint32_t x, uint32_t y);

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
