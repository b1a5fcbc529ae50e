#include "surface/patches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

// Links keep indices of 32 bits; the highest bit is left to how they are stored.
constexpr uint64_t kMaxPatches = uint64_t{1} << 31;

// Size of the copy of the facet a node looks from, over one of the k² triangles. Larger ones average away
// what nodes are for: at the bottom of a pit they look from further up. Measured against the referee, 20
// bounces at albedo 1 where AO is below 0.1: WallHeight +8 % at 0.1, +3 % at 0.05, −1 % at 0.02, bricks +4 %
// at 0.1 and +0.5 % at 0.04; the second bounce of all bricks +0.4 and +0.2 %. Smaller ones see more of each
// other in deep folds, which take longer to converge: WallHeight at 64 rays 169, 233 and 353 products at 0.1,
// 0.06 and 0.04.
constexpr double kNodeSize = 0.04;

double longest_edge_texels(const Surface& surface, uint32_t facet) {
  const auto p = facet_positions_texels(surface, facet);
  return std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
}

int subdivision_of_run(const Surface& surface, uint32_t first_cell, uint32_t cells) {
  for (uint32_t facet = 2 * first_cell; facet < 2 * (first_cell + cells); ++facet)
    if (longest_edge_texels(surface, facet) > kLongestCoarseEdge) return kFineSubdivision;
  return kCoarseSubdivision;
}

struct NodePlace {
  int a, b;  // column and row, in units of 1/k
};

NodePlace node_place(int k, uint32_t node) {
  int a = static_cast<int>(node), b = 0;
  while (a > k - b) a -= k - b++ + 1;
  return {a, b};
}

uint32_t rows_of_tile(const PatchSet& patches, uint32_t first_row) {
  return std::min(kTileRows, patches.cell_rows - first_row);
}

// The run that begins at cell `column` of a row. No division: every link of a bake asks for one.
PatchRun run_at(const PatchSet& patches, uint32_t row, uint32_t column) {
  const uint32_t row_in_tile = row % kTileRows, first_row = row - row_in_tile;
  const uint32_t run =
      first_row * patches.runs_in_row + column / kRunCells * rows_of_tile(patches, first_row) + row_in_tile;
  PatchRun result;
  result.first = patches.first[run];
  result.first_cell = row * patches.columns + column;
  result.cells = std::min(kRunCells, patches.columns - column);
  const bool coarse =
      patches.first[run + 1] - result.first == 2 * node_count(kCoarseSubdivision) * result.cells;
  result.subdivision = coarse ? kCoarseSubdivision : kFineSubdivision;
  return result;
}

}  // namespace

PatchSet make_patches(const Surface& surface, Patches kind) {
  PatchSet patches;
  patches.kind = kind;
  if (kind == Patches::kTexels) {
    patches.count = surface.texel_count();
    return patches;
  }
  patches.columns = facet_columns(surface);
  patches.runs_in_row = (patches.columns + kRunCells - 1) / kRunCells;
  patches.cell_rows = patches.columns == 0 ? 0 : facet_count(surface) / 2 / patches.columns;
  uint64_t count = 0;
  for (uint32_t first_row = 0; first_row < patches.cell_rows; first_row += kTileRows)
    for (uint32_t column = 0; column < patches.columns; column += kRunCells) {
      const uint32_t cells = std::min(kRunCells, patches.columns - column);
      for (uint32_t row = first_row; row < first_row + rows_of_tile(patches, first_row); ++row) {
        patches.first.push_back(static_cast<uint32_t>(count));
        count += 2 * node_count(subdivision_of_run(surface, row * patches.columns + column, cells)) * cells;
        if (count > kMaxPatches)
          throw InputError(
              fmt::format("more than {} patches, expected a smaller map, or texels as patches", kMaxPatches));
      }
    }
  patches.count = static_cast<uint32_t>(count);
  patches.first.push_back(patches.count);
  return patches;
}

glm::dvec2 node_uv(int k, uint32_t node) {
  const NodePlace place = node_place(k, node);
  return glm::dvec2(place.a, place.b) / static_cast<double>(k);
}

PatchRun patch_run(const PatchSet& patches, uint32_t run) {
  const uint32_t first_row = run / (kTileRows * patches.runs_in_row) * kTileRows;
  const uint32_t in_row_of_tiles = run - first_row * patches.runs_in_row,
                 rows = rows_of_tile(patches, first_row);
  return run_at(patches, first_row + in_row_of_tiles % rows, in_row_of_tiles / rows * kRunCells);
}

PatchRun run_of_patch(const PatchSet& patches, uint32_t patch) {
  const auto after = std::upper_bound(patches.first.begin(), patches.first.end(), patch);
  return patch_run(patches, static_cast<uint32_t>(after - patches.first.begin() - 1));
}

FacetNode facet_node(const PatchSet& patches, uint32_t patch) {
  const PatchRun run = run_of_patch(patches, patch);
  const uint32_t in_run = patch - run.first, nodes = node_count(run.subdivision);
  const uint32_t cell = run.first_cell + in_run % run.cells, half_and_node = in_run / run.cells;
  return {2 * cell + half_and_node / nodes, run.subdivision, half_and_node % nodes};
}

std::array<PatchShare, 3> patch_shares(const PatchSet& patches, uint32_t facet, glm::dvec2 uv) {
  const uint32_t cell = facet / 2, row = cell / patches.columns, column = cell - row * patches.columns;
  const PatchRun run = run_at(patches, row, column / kRunCells * kRunCells);
  const int k = run.subdivision;
  const double u = std::clamp(uv.x, 0.0, 1.0) * k, v = std::clamp(uv.y, 0.0, 1.0) * k;
  const int a = std::min(static_cast<int>(u), k - 1), b = std::min(static_cast<int>(v), k - 1 - a);
  const double fu = u - a, fv = std::min(v - b, 1.0);
  const auto patch_at = [&](int column_of_node, int row_of_node) {
    return run.patch(facet % 2, node_at(k, column_of_node, row_of_node), column % kRunCells);
  };
  // The half of the little square at (a, b) that is a triangle like the facet, or the other way round. On the
  // facet's long side there is only the first kind, whatever fu + fv rounds to.
  if (fu + fv <= 1 || a + b == k - 1) {
    const double share_u = std::min(fu, 1.0), share_v = std::min(fv, 1 - share_u);
    return {{{patch_at(a + 1, b), share_u},
             {patch_at(a, b + 1), share_v},
             {patch_at(a, b), 1 - share_u - share_v}}};
  }
  return {
      {{patch_at(a, b + 1), 1 - fu}, {patch_at(a + 1, b), 1 - fv}, {patch_at(a + 1, b + 1), fu + fv - 1}}};
}

uint32_t draw_patch(const PatchSet& patches, uint32_t facet, glm::dvec2 uv, double choice) {
  const std::array<PatchShare, 3> shares = patch_shares(patches, facet, uv);
  if (choice < shares[0].share) return shares[0].patch;
  return choice < shares[0].share + shares[1].share ? shares[1].patch : shares[2].patch;
}

glm::dvec2 node_start_uv(int k, uint32_t node, glm::dvec2 point) {
  const double size = kNodeSize / k;
  return (1 - size) * node_uv(k, node) + size * point;
}

double node_area_share(int k, uint32_t node) {
  const NodePlace place = node_place(k, node);
  const int a = place.a, b = place.b, c = k - a - b;
  const int sides = (a == 0) + (b == 0) + (c == 0);
  // Linear: each of the k² triangles around the node adds a third of itself, six inside, three along a side
  // of the facet, one at its corner. Quadratic: of each four of them that make a larger triangle, the nodes
  // at the middles of its sides count, equally.
  const double linear = (sides == 0 ? 6 : sides == 1 ? 3 : 1) / (3.0 * k * k);
  const bool middle = a % 2 + b % 2 + c % 2 == 2;
  const double quadratic = middle ? (sides == 0 ? 8 : 4) / (3.0 * k * k) : 0;
  return (linear + quadratic) / 2;
}

double patch_area_texels(const Surface& surface, const PatchSet& patches, uint32_t patch) {
  const FacetNode node = facet_node(patches, patch);
  return 0.5 * facet_area_ratio(surface, node.facet) * node_area_share(node.subdivision, node.node);
}

glm::dvec2 patch_position_texels(const Surface& surface, const PatchSet& patches, uint32_t patch) {
  if (patches.kind == Patches::kTexels) {
    const uint32_t width = static_cast<uint32_t>(surface.width());
    return {patch % width, patch / width};
  }
  const FacetNode node = facet_node(patches, patch);
  return facet_point_texels(surface, node.facet, node_uv(node.subdivision, node.node));
}

}  // namespace hemibake
