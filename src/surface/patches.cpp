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

// Returns the bits of a run's texels whose cell has a finely cut facet, for either half. y: of the cells.
std::array<uint32_t, 2> fine_halves(const Surface& surface, uint32_t first_cell, uint32_t cells) {
  std::array<uint32_t, 2> fine{};
  for (uint32_t facet = 0; facet < 2 * cells; ++facet)
    if (longest_edge_texels(surface, 2 * first_cell + facet) > kLongestCoarseEdge)
      fine[facet % 2] |= 1u << facet / 2;
  return fine;
}

constexpr std::array<std::array<uint8_t, 5>, 5> make_nodes_at() {
  std::array<std::array<uint8_t, 5>, 5> nodes{};
  for (size_t node = 0; node < kFineNodes; ++node)
    nodes[static_cast<size_t>(kNodePlaces[node].b)][static_cast<size_t>(kNodePlaces[node].a)] =
        static_cast<uint8_t>(node);
  return nodes;
}
constexpr std::array<std::array<uint8_t, 5>, 5> kNodesAt = make_nodes_at();  // [row][column], in quarters

// Returns the number of bits of a mask of 16; std::popcount is a function call on plain x86-64.
uint32_t bits_in(uint32_t mask) {
  mask -= mask >> 1 & 0x5555;
  mask = (mask & 0x3333) + (mask >> 2 & 0x3333);
  mask = (mask + (mask >> 4)) & 0x0f0f;
  return (mask + (mask >> 8)) & 0x1f;
}

// Returns the facet whose cut decides whether a slot's node is there; of finer nodes only.
constexpr FineFacet fine_facet(const NodeSlot& slot) {
  return slot.half == 0   ? kFirstHalf
         : slot.left == 1 ? kLeftOfTexel
         : slot.up == 1   ? kAboveTexel
                          : kSecondHalf;
}

// [slot][facet]: slots from kCoarseSlots on before it whose nodes are on that facet.
constexpr std::array<std::array<uint8_t, 4>, kSlots + 1> make_fine_before() {
  std::array<std::array<uint8_t, 4>, kSlots + 1> before{};
  for (size_t slot = kCoarseSlots + 1; slot <= kSlots; ++slot) {
    before[slot] = before[slot - 1];
    ++before[slot][fine_facet(kNodeSites.slots[slot - 1])];
  }
  return before;
}
constexpr std::array<std::array<uint8_t, 4>, kSlots + 1> kFineBefore = make_fine_before();

constexpr std::array<FineFacet, kSlots> make_fine_facet_of() {
  std::array<FineFacet, kSlots> facets{};
  for (size_t slot = 0; slot < kSlots; ++slot) facets[slot] = fine_facet(kNodeSites.slots[slot]);
  return facets;
}
constexpr std::array<FineFacet, kSlots> kFineFacetOf = make_fine_facet_of();

// Returns the patches of the slots from kCoarseSlots on before a slot of such a run.
uint32_t fine_patches_before(const std::array<uint8_t, 4>& fine_count, uint32_t slot) {
  const std::array<uint8_t, 4>& before = kFineBefore[slot];
  return uint32_t{before[0]} * fine_count[0] + uint32_t{before[1]} * fine_count[1] +
         uint32_t{before[2]} * fine_count[2] + uint32_t{before[3]} * fine_count[3];
}

uint32_t rows_of_tile(const PatchSet& patch_set, uint32_t first_row) {
  return std::min(kTileRows, patch_set.height - first_row);
}

// Returns the number of the run that a texel is in.
uint32_t run_index(const PatchSet& patch_set, uint32_t x, uint32_t y) {
  const uint32_t row_in_tile = y % kTileRows, first_row = y - row_in_tile;
  return first_row * patch_set.runs_in_row + x / kRunTexels * rows_of_tile(patch_set, first_row) +
         row_in_tile;
}

// Returns a run with the cells around its texels, and nothing else.
PatchRun make_run(const PatchSet& patch_set, uint32_t x, uint32_t y) {
  PatchRun run{0, x, y, std::min(kRunTexels, patch_set.width - x), true, {}, {}, {}};
  const uint32_t all = (1u << run.texels) - 1;
  uint32_t here = all, left = all;
  bool row_here = true, row_above = true;
  if (patch_set.columns != patch_set.width) {
    if (x + run.texels > patch_set.columns) here >>= 1;
    if (x == 0) left &= ~1u;
    row_here = y < patch_set.cell_rows;
    row_above = y > 0;
    run.whole = here == all && left == all && row_here && row_above;
  }
  run.cells = {static_cast<uint16_t>(row_here ? here : 0), static_cast<uint16_t>(row_here ? left : 0),
               static_cast<uint16_t>(row_above ? here : 0), static_cast<uint16_t>(row_above ? left : 0)};
  return run;
}

// Returns a run by one of its texels.
PatchRun run_at(const PatchSet& patch_set, uint32_t x, uint32_t y) {
  PatchRun run = make_run(patch_set, x - x % kRunTexels, y);
  const StoredRun& stored = patch_set.runs[run_index(patch_set, x, y)];
  run.first = stored.first;
  run.fine = stored.fine;
  run.fine_count = stored.fine_count;
  return run;
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

// A facet by its cell.
struct FacetPlace {
  uint32_t column, row, half;
};

// Without division: every form factor asks for one.
FacetPlace place_of(const PatchSet& patch_set, uint32_t facet) {
  const uint32_t cell = facet / 2, row = static_cast<uint32_t>((cell + 0.5) * patch_set.inverse_columns);
  return {cell - row * patch_set.columns, row, facet % 2};
}

int subdivision_at(const PatchSet& patch_set, const FacetPlace& place) {
  const StoredRun& run = patch_set.runs[run_index(patch_set, place.column, place.row)];
  const uint32_t fine = run.fine[place.half == 0 ? kFirstHalf : kSecondHalf];
  return (fine >> place.column % kRunTexels & 1) != 0 ? kFineSubdivision : kCoarseSubdivision;
}

uint32_t patch_at_place(const PatchSet& patch_set, const FacetPlace& place, uint32_t node) {
  const uint32_t slot = kNodeSites.slot_of[place.half][node];
  uint32_t x = place.column + kNodeSites.slots[slot].left, y = place.row + kNodeSites.slots[slot].up;
  if (x == patch_set.width) x = 0;
  if (y == patch_set.height) y = 0;
  const uint32_t lane = x % kRunTexels, first_x = x - lane;
  const bool wraps = patch_set.columns == patch_set.width;
  const bool inside =
      first_x > 0 && first_x + kRunTexels <= patch_set.columns && y > 0 && y < patch_set.cell_rows;
  if (wraps || inside) {
    const StoredRun& run = patch_set.runs[run_index(patch_set, x, y)];
    const uint32_t texels = std::min(kRunTexels, patch_set.width - first_x);
    if (slot < kCoarseSlots) return run.first + slot * texels + lane;
    return run.first + kCoarseSlots * texels + fine_patches_before(run.fine_count, slot) +
           bits_in(run.fine[kFineFacetOf[slot]] & ((1u << lane) - 1));
  }
  const PatchRun run = run_at(patch_set, x, y);
  return run.first_of(slot) + bits_in(run.texels_with(slot) & ((1u << lane) - 1));
}

uint32_t patches_of_run(const PatchRun& run) {
  uint32_t count = 0;
  for (uint32_t slot = 0; slot < kSlots; ++slot) count += bits_in(run.texels_with(slot));
  return count;
}

// Finds the finely cut facets around the texels of all runs.
void find_fine_facets(const Surface& surface, PatchSet& patch_set) {
  const auto mark = [&](uint32_t x, uint32_t y, FineFacet facet) {
    StoredRun& run = patch_set.runs[run_index(patch_set, x, y)];
    run.fine[facet] |= static_cast<uint16_t>(1u << x % kRunTexels);
    ++run.fine_count[facet];
  };
  for (uint32_t row = 0; row < patch_set.cell_rows; ++row)
    for (uint32_t column = 0; column < patch_set.columns; column += kRunTexels) {
      const uint32_t cells = std::min(kRunTexels, patch_set.columns - column);
      const std::array<uint32_t, 2> halves = fine_halves(surface, row * patch_set.columns + column, cells);
      for (uint32_t x = column; x < column + cells; ++x) {
        if ((halves[0] >> (x - column) & 1) != 0) mark(x, row, kFirstHalf);
        if ((halves[1] >> (x - column) & 1) == 0) continue;
        mark(x, row, kSecondHalf);
        mark(x + 1 == patch_set.width ? 0 : x + 1, row, kLeftOfTexel);
        mark(x, row + 1 == patch_set.height ? 0 : row + 1, kAboveTexel);
      }
    }
}

}  // namespace

PatchSet make_patches(const Surface& surface, PatchKind kind) {
  PatchSet patch_set;
  patch_set.kind = kind;
  if (kind == PatchKind::kTexels) {
    patch_set.count = surface.texel_count();
    return patch_set;
  }
  patch_set.width = static_cast<uint32_t>(surface.width());
  patch_set.height = static_cast<uint32_t>(surface.height());
  patch_set.columns = facet_columns(surface);
  patch_set.inverse_columns = 1.0 / std::max(1u, patch_set.columns);
  patch_set.runs_in_row = (patch_set.width + kRunTexels - 1) / kRunTexels;
  patch_set.cell_rows = patch_set.columns == 0 ? 0 : facet_count(surface) / 2 / patch_set.columns;
  patch_set.runs.resize(size_t{patch_set.runs_in_row} * patch_set.height);
  find_fine_facets(surface, patch_set);
  uint64_t count = 0;
  for (uint32_t first_row = 0; first_row < patch_set.height; first_row += kTileRows)
    for (uint32_t x = 0; x < patch_set.width; x += kRunTexels)
      for (uint32_t y = first_row; y < first_row + rows_of_tile(patch_set, first_row); ++y) {
        patch_set.runs[run_index(patch_set, x, y)].first = static_cast<uint32_t>(count);
        count += patches_of_run(run_at(patch_set, x, y));
        if (count > kMaxPatches)
          throw InputError(
              fmt::format("more than {} patches, expected a smaller map, or texels as patches", kMaxPatches));
      }
  patch_set.count = static_cast<uint32_t>(count);
  patch_set.runs.push_back({patch_set.count, {}, {}});
  return patch_set;
}

glm::dvec2 node_uv(uint32_t node) {
  return glm::dvec2(kNodePlaces[node].a, kNodePlaces[node].b) / static_cast<double>(kFineSubdivision);
}

uint32_t node_at(int k, int column, int row) {
  const int quarters = kFineSubdivision / k;
  return kNodesAt[static_cast<size_t>(row * quarters)][static_cast<size_t>(column * quarters)];
}

uint32_t PatchRun::texels_with(uint32_t slot) const {
  const NodeSlot& node = kNodeSites.slots[slot];
  if (slot >= kCoarseSlots) return fine[kFineFacetOf[slot]];
  return cells[static_cast<size_t>(node.left + 2 * node.up)];
}

uint32_t PatchRun::first_of(uint32_t slot) const {
  const uint32_t coarse = std::min(slot, kCoarseSlots);
  uint32_t begin = first + coarse * texels;
  if (!whole) {
    begin = first;
    for (uint32_t before = 0; before < coarse; ++before) begin += bits_in(texels_with(before));
  }
  return slot <= kCoarseSlots ? begin : begin + fine_patches_before(fine_count, slot);
}

PatchRun run_of_patch(const PatchSet& patch_set, uint32_t patch) {
  const auto after =
      std::upper_bound(patch_set.runs.begin(), patch_set.runs.end(), patch,
                       [](uint32_t wanted, const StoredRun& run) { return wanted < run.first; });
  const auto run = static_cast<uint32_t>(after - patch_set.runs.begin() - 1);
  const uint32_t first_row = run / (kTileRows * patch_set.runs_in_row) * kTileRows;
  const uint32_t in_row_of_tiles = run - first_row * patch_set.runs_in_row,
                 rows = rows_of_tile(patch_set, first_row);
  return run_at(patch_set, in_row_of_tiles / rows * kRunTexels, first_row + in_row_of_tiles % rows);
}

uint32_t facet_of_slot(const PatchSet& patch_set, uint32_t slot, uint32_t x, uint32_t y) {
  const NodeSlot& node = kNodeSites.slots[slot];
  const uint32_t column = node.left <= x ? x - node.left : patch_set.width - 1,
                 row = node.up <= y ? y - node.up : patch_set.height - 1;
  return 2 * (row * patch_set.columns + column) + node.half;
}

int subdivision(const PatchSet& patch_set, uint32_t facet) {
  return subdivision_at(patch_set, place_of(patch_set, facet));
}

uint32_t patch_at(const PatchSet& patch_set, uint32_t facet, uint32_t node) {
  return patch_at_place(patch_set, place_of(patch_set, facet), node);
}

FacetNode facet_node(const PatchSet& patch_set, uint32_t patch) {
  const PatchRun run = run_of_patch(patch_set, patch);
  uint32_t slot = kSlots - 1;
  while (run.first_of(slot) > patch || run.texels_with(slot) == 0) --slot;
  uint32_t texels = run.texels_with(slot);
  for (uint32_t before = patch - run.first_of(slot); before > 0; --before) texels &= texels - 1;
  const uint32_t x = run.x + static_cast<uint32_t>(std::countr_zero(texels));
  const uint32_t facet = facet_of_slot(patch_set, slot, x, run.y);
  return {facet, subdivision(patch_set, facet), kNodeSites.slots[slot].node};
}

std::array<PatchShare, 3> patch_shares(const PatchSet& patch_set, uint32_t facet, glm::dvec2 uv) {
  const FacetPlace place = place_of(patch_set, facet);
  const int k = subdivision_at(patch_set, place);
  const std::array<NodeShare, 3> nodes = node_shares(k, uv);
  std::array<PatchShare, 3> shares;
  for (size_t i = 0; i < nodes.size(); ++i)
    shares[i] = {patch_at_place(patch_set, place, node_at(k, nodes[i].a, nodes[i].b)), nodes[i].share};
  return shares;
}

uint32_t sample_patch(const PatchSet& patch_set, uint32_t facet, glm::dvec2 uv, double u) {
  const FacetPlace place = place_of(patch_set, facet);
  const int k = subdivision_at(patch_set, place);
  const std::array<NodeShare, 3> nodes = node_shares(k, uv);
  const size_t drawn = u < nodes[0].share ? 0 : u < nodes[0].share + nodes[1].share ? 1 : 2;
  return patch_at_place(patch_set, place, node_at(k, nodes[drawn].a, nodes[drawn].b));
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
