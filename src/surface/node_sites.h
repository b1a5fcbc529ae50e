// The places of a texel's cell at which nodes stand, and the nodes that stand there together: at a texel
// those of the six facets around it, on an edge those of the two facets beside it, inside a facet its own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>

namespace hemibake {

inline constexpr uint32_t kFineNodes = 15;  // of a facet cut into 4² triangles, 6 of one cut into 2²
inline constexpr uint32_t kSlots = 2 * kFineNodes;  // nodes of a texel
inline constexpr uint32_t kCoarseSlots = 12;        // of them, those of coarsely cut facets: the first ones
inline constexpr uint32_t kSites = 16;
inline constexpr uint32_t kMostAtSite = 6;

// Column and row of a node on its facet, in quarters: first the corners and the middles of the sides, row by
// row, then the nine more of a finely cut facet.
struct NodePlace {
  int a, b;
};
inline constexpr NodePlace kNodePlaces[kFineNodes] = {{0, 0}, {2, 0}, {4, 0}, {0, 2}, {2, 2},
                                                      {0, 4}, {1, 0}, {3, 0}, {0, 1}, {1, 1},
                                                      {2, 1}, {3, 1}, {1, 2}, {0, 3}, {1, 3}};

// A node of a texel: on a half of the cell that is `left` columns and `up` rows before the texel's own.
struct NodeSlot {
  uint8_t site;
  uint8_t half, node;
  uint8_t left, up;
};

struct NodeSite {
  int8_t x, y;  // from the texel, in quarters of a texel
  uint8_t first_slot, slots;
};

struct NodeSiteTable {
  std::array<NodeSite, kSites> sites{};
  std::array<NodeSlot, kSlots> slots{};
  std::array<std::array<uint8_t, kFineNodes>, 2> slot_of{};  // [half][node]
};

// Returns where a node stands from the first corner of its cell, in quarters.
constexpr NodePlace place_in_cell(uint32_t half, uint32_t node) {
  const NodePlace place = kNodePlaces[node];
  return half == 0 ? place : NodePlace{4 - place.a, 4 - place.b};
}

// Collects the nodes by site: those of coarsely cut facets first.
constexpr NodeSiteTable make_node_sites() {
  NodeSiteTable table;
  uint32_t sites = 0, slots = 0;
  for (const bool fine : {false, true})
    for (uint32_t first_half = 0; first_half < 2; ++first_half)
      for (uint32_t first_node = fine ? 6 : 0; first_node < (fine ? kFineNodes : 6); ++first_node) {
        const NodePlace at = place_in_cell(first_half, first_node);
        const int x = at.a % 4, y = at.b % 4;
        bool known = false;
        for (uint32_t site = 0; site < sites; ++site)
          known = known || (table.sites[site].x == x && table.sites[site].y == y);
        if (known) continue;
        NodeSite site{static_cast<int8_t>(x), static_cast<int8_t>(y), static_cast<uint8_t>(slots), 0};
        for (uint32_t half = 0; half < 2; ++half)
          for (uint32_t node = 0; node < kFineNodes; ++node) {
            const NodePlace place = place_in_cell(half, node);
            if (place.a % 4 != x || place.b % 4 != y) continue;
            table.slot_of[half][node] = static_cast<uint8_t>(slots);
            table.slots[slots++] = {static_cast<uint8_t>(sites), static_cast<uint8_t>(half),
                                    static_cast<uint8_t>(node), static_cast<uint8_t>(place.a / 4),
                                    static_cast<uint8_t>(place.b / 4)};
            ++site.slots;
          }
        table.sites[sites++] = site;
      }
  return table;
}
inline constexpr NodeSiteTable kNodeSites = make_node_sites();

static_assert(kNodeSites.sites[0].slots == kMostAtSite && kNodeSites.sites[kSites - 1].slots == 1);
static_assert(kNodeSites.sites[4].first_slot == kCoarseSlots);

}  // namespace hemibake
