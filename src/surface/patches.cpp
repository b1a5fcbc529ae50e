#include "surface/patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

// Form-factor matrices keep indices of 32 bits; their storage uses the highest bit.
constexpr uint64_t kMaxPatches = uint64_t{1} << 31;

// Size of the copy of the facet that a node's rays start in, over the facet. In larger copies nodes at the
// bottom of a pit look from further up; in smaller ones nodes in deep folds see more of each other, and their
// light takes longer to converge.
constexpr double kNodeSize = 0.01;

double longest_edge_texels(const Surface& surface, uint32_t facet) {
  const auto p = facet_positions_texels(surface, facet);
  return std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
}

std::array<uint16_t, 2> fine_facets(const Surface& surface, uint32_t first_cell, uint32_t cells) {
  std::array<uint16_t, 2> fine{};
  for (uint32_t facet = 0; facet < 2 * cells; ++facet)
    if (longest_edge_texels(surface, 2 * first_cell + facet) > kLongestCoarseEdge)
      fine[facet % 2] |= static_cast<uint16_t>(1u << facet / 2);
  return fine;
}

struct NodePlace {
  int a, b;  // column and row, in quarters
};
constexpr NodePlace kNodePlaces[kFineNodes] = {{0, 0}, {2, 0}, {4, 0}, {0, 2}, {2, 2}, {0, 4}, {1, 0}, {3, 0},
                                               {0, 1}, {1, 1}, {2, 1}, {3, 1}, {1, 2}, {0, 3}, {1, 3}};

constexpr std::array<std::array<uint8_t, 5>, 5> make_nodes_at() {
  std::array<std::array<uint8_t, 5>, 5> nodes{};
  for (size_t node = 0; node < kFineNodes; ++node)
    nodes[static_cast<size_t>(kNodePlaces[node].b)][static_cast<size_t>(kNodePlaces[node].a)] =
        static_cast<uint8_t>(node);
  return nodes;
}
constexpr std::array<std::array<uint8_t, 5>, 5> kNodesAt = make_nodes_at();  // [row][column], in quarters

uint32_t bits_in(uint32_t mask) { return static_cast<uint32_t>(std::popcount(mask)); }

uint32_t patches_of_half(const PatchRun& run, uint32_t half) {
  return kCoarseNodes * run.cells + (kFineNodes - kCoarseNodes) * bits_in(run.fine[half]);
}

// Returns the offset of a node's first patch from that of its half.
uint32_t begin_of_node(const PatchRun& run, uint32_t half, uint32_t node) {
  if (node < kCoarseNodes) return node * run.cells;
  return kCoarseNodes * run.cells + (node - kCoarseNodes) * bits_in(run.fine[half]);
}

uint32_t rows_of_tile(const PatchSet& patch_set, uint32_t first_row) {
  return std::min(kTileRows, patch_set.cell_rows - first_row);
}

// Returns the run that begins at cell `column` of a row. Without division: every form factor asks for one.
PatchRun run_at(const PatchSet& patch_set, uint32_t row, uint32_t column) {
  const uint32_t row_in_tile = row % kTileRows, first_row = row - row_in_tile;
  const uint32_t run = first_row * patch_set.runs_in_row +
                       column / kRunCells * rows_of_tile(patch_set, first_row) + row_in_tile;
  return {patch_set.first[run], row * patch_set.columns + column,
          std::min(kRunCells, patch_set.columns - column), patch_set.fine[run]};
}

// Returns the run that a patch is in.
PatchRun run_of_patch(const PatchSet& patch_set, uint32_t patch) {
  const auto after = std::upper_bound(patch_set.first.begin(), patch_set.first.end(), patch);
  return patch_run(patch_set, static_cast<uint32_t>(after - patch_set.first.begin() - 1));
}

// Share of a node in the light at a point of a facet. a, b: column and row of the node, in units of 1/k.
struct NodeShare {
  int a, b;
  double share;
};

std::array<NodeShare, 3> node_shares(int k, glm::dvec2 uv) {
  const double u = std::clamp(uv.x, 0.0, 1.0) * k, v = std::clamp(uv.y, 0.0, 1.0) * k;
  const int a = std::min(static_cast<int>(u), k - 1), b = std::min(static_cast<int>(v), k - 1 - a);
  const double fu = u - a, fv = std::min(v - b, 1.0);
  // In the little square at (a, b), a triangle like the facet, or one the other way round. Along the facet's
  // long side there is only the first kind, whatever fu + fv rounds to.
  if (fu + fv <= 1 || a + b == k - 1) {
    const double share_u = std::min(fu, 1.0), share_v = std::min(fv, 1 - share_u);
    return {{{a + 1, b, share_u}, {a, b + 1, share_v}, {a, b, 1 - share_u - share_v}}};
  }
  return {{{a, b + 1, 1 - fu}, {a + 1, b, 1 - fv}, {a + 1, b + 1, fu + fv - 1}}};
}

// A facet in its run.
struct FacetInRun {
  PatchRun run;
  uint32_t half, cell;
  int k() const { return run.subdivision(half, cell); }
  uint32_t patch(const NodeShare& share) const {
    return run.patch(half, node_at(k(), share.a, share.b), cell);
  }
};

FacetInRun facet_in_run(const PatchSet& patch_set, uint32_t facet) {
  const uint32_t cell = facet / 2, row = cell / patch_set.columns, column = cell - row * patch_set.columns;
  const uint32_t cell_in_run = column % kRunCells;
  return {run_at(patch_set, row, column - cell_in_run), facet % 2, cell_in_run};
}

}  // namespace

PatchSet make_patches(const Surface& surface, PatchKind kind) {
  PatchSet patch_set;
  patch_set.kind = kind;
  if (kind == PatchKind::kTexels) {
    patch_set.count = surface.texel_count();
    return patch_set;
  }
  patch_set.columns = facet_columns(surface);
  patch_set.runs_in_row = (patch_set.columns + kRunCells - 1) / kRunCells;
  patch_set.cell_rows = patch_set.columns == 0 ? 0 : facet_count(surface) / 2 / patch_set.columns;
  uint64_t count = 0;
  for (uint32_t first_row = 0; first_row < patch_set.cell_rows; first_row += kTileRows)
    for (uint32_t column = 0; column < patch_set.columns; column += kRunCells) {
      const uint32_t cells = std::min(kRunCells, patch_set.columns - column);
      for (uint32_t row = first_row; row < first_row + rows_of_tile(patch_set, first_row); ++row) {
        PatchRun run{static_cast<uint32_t>(count), row * patch_set.columns + column, cells, {}};
        run.fine = fine_facets(surface, run.first_cell, cells);
        patch_set.first.push_back(run.first);
        patch_set.fine.push_back(run.fine);
        count += patches_of_half(run, 0) + patches_of_half(run, 1);
        if (count > kMaxPatches)
          throw InputError(
              fmt::format("more than {} patches, expected a smaller map, or texels as patches", kMaxPatches));
      }
    }
  patch_set.count = static_cast<uint32_t>(count);
  patch_set.first.push_back(patch_set.count);
  return patch_set;
}

glm::dvec2 node_uv(uint32_t node) {
  return glm::dvec2(kNodePlaces[node].a, kNodePlaces[node].b) / static_cast<double>(kFineSubdivision);
}

uint32_t node_at(int k, int column, int row) {
  const int quarters = kFineSubdivision / k;
  return kNodesAt[static_cast<size_t>(row * quarters)][static_cast<size_t>(column * quarters)];
}

uint32_t PatchRun::patch(uint32_t half, uint32_t node, uint32_t cell_in_run) const {
  const uint32_t of_half = first + (half == 0 ? 0 : patches_of_half(*this, 0));
  return of_half + begin_of_node(*this, half, node) +
         bits_in(cells_with(half, node) & ((1u << cell_in_run) - 1));
}

PatchRun patch_run(const PatchSet& patch_set, uint32_t run) {
  const uint32_t first_row = run / (kTileRows * patch_set.runs_in_row) * kTileRows;
  const uint32_t in_row_of_tiles = run - first_row * patch_set.runs_in_row,
                 rows = rows_of_tile(patch_set, first_row);
  return run_at(patch_set, first_row + in_row_of_tiles % rows, in_row_of_tiles / rows * kRunCells);
}

NodeGroup group_of_patch(const PatchSet& patch_set, uint32_t patch) {
  NodeGroup group{run_of_patch(patch_set, patch), 0, 0, 0};
  const PatchRun& run = group.run;
  uint32_t begin = run.first;
  if (const uint32_t first_half = patches_of_half(run, 0); patch - begin >= first_half) {
    group.half = 1;
    begin += first_half;
  }
  const uint32_t in_half = patch - begin, coarse = kCoarseNodes * run.cells;
  group.node = in_half < coarse ? in_half / run.cells
                                : kCoarseNodes + (in_half - coarse) / bits_in(run.fine[group.half]);
  group.first = begin + begin_of_node(run, group.half, group.node);
  return group;
}

FacetNode facet_node(const PatchSet& patch_set, uint32_t patch) {
  const NodeGroup group = group_of_patch(patch_set, patch);
  uint32_t cells = group.run.cells_with(group.half, group.node);
  for (uint32_t before = patch - group.first; before > 0; --before) cells &= cells - 1;
  const uint32_t cell = static_cast<uint32_t>(std::countr_zero(cells));
  return {2 * (group.run.first_cell + cell) + group.half, group.run.subdivision(group.half, cell),
          group.node};
}

std::array<PatchShare, 3> patch_shares(const PatchSet& patch_set, uint32_t facet, glm::dvec2 uv) {
  const FacetInRun place = facet_in_run(patch_set, facet);
  const std::array<NodeShare, 3> nodes = node_shares(place.k(), uv);
  std::array<PatchShare, 3> shares;
  for (size_t i = 0; i < nodes.size(); ++i) shares[i] = {place.patch(nodes[i]), nodes[i].share};
  return shares;
}

uint32_t sample_patch(const PatchSet& patch_set, uint32_t facet, glm::dvec2 uv, double u) {
  const FacetInRun place = facet_in_run(patch_set, facet);
  const std::array<NodeShare, 3> nodes = node_shares(place.k(), uv);
  const size_t drawn = u < nodes[0].share ? 0 : u < nodes[0].share + nodes[1].share ? 1 : 2;
  return place.patch(nodes[drawn]);
}

glm::dvec2 node_start_uv(uint32_t node, glm::dvec2 point) {
  return (1 - kNodeSize) * node_uv(node) + kNodeSize * point;
}

double node_area_share(int k, uint32_t node) {
  const int quarters = kFineSubdivision / k;
  const int a = kNodePlaces[node].a / quarters, b = kNodePlaces[node].b / quarters, c = k - a - b;
  const int sides = (a == 0) + (b == 0) + (c == 0);
  // Linear: each of the k² triangles around the node adds a third of itself, six inside, three along a side
  // of the facet, one at its corner. Quadratic: of each four of them that make a larger triangle, the nodes
  // at the middles of its sides count, equally.
  const double linear = (sides == 0 ? 6 : sides == 1 ? 3 : 1) / (3.0 * k * k);
  const bool middle = a % 2 + b % 2 + c % 2 == 2;
  const double quadratic = middle ? (sides == 0 ? 8 : 4) / (3.0 * k * k) : 0;
  const double quadratic_share = k == kCoarseSubdivision ? 1 : 0.25;
  return (1 - quadratic_share) * linear + quadratic_share * quadratic;
}

double patch_area_texels(const Surface& surface, const PatchSet& patch_set, uint32_t patch) {
  const FacetNode node = facet_node(patch_set, patch);
  return 0.5 * facet_area_ratio(surface, node.facet) * node_area_share(node.subdivision, node.node);
}

glm::dvec2 patch_position_texels(const Surface& surface, const PatchSet& patch_set, uint32_t patch) {
  if (patch_set.kind == PatchKind::kTexels) {
    const uint32_t width = static_cast<uint32_t>(surface.width());
    return {patch % width, patch / width};
  }
  const FacetNode node = facet_node(patch_set, patch);
  return facet_point_texels(surface, node.facet, node_uv(node.node));
}

}  // namespace hemibake
