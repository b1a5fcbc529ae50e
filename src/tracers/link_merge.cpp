#include "tracers/link_merge.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace hemibake {
namespace {

int settle_index(int i, int n, Edge edge) {
  return edge == Edge::kWrap ? wrap_index(i, n) : std::clamp(i, 0, n - 1);
}

void add_link(const Surface& surface, int x, int y, double weight, std::vector<FormFactor>& links) {
  if (weight <= 0) return;
  const int i = settle_index(x, surface.width(), surface.edge),
            j = settle_index(y, surface.height(), surface.edge);
  links.push_back({static_cast<uint32_t>(surface.heights_m.index(i, j)), static_cast<float>(weight)});
}

constexpr uint32_t kFree = 0xffffffff;

// Texels: a hit nearer than this is linked to all nodes around it. It is the distance of the nodes of a long
// facet; in a deep fold most rays hit nearer.
constexpr double kNear = 0.25;
// What such a hit is worth is shared in whole parts: rows of hits that weigh alike are then stored as they
// are (transport/links/form_factors.h). With eighths a deep pit of WallHeight kept its light at 32 rays.
constexpr double kNearParts = 16;

// Leaves each patch once, in order of its first link, weights summed in double in the order of the links. A
// hash table of the patches met so far: most rays of a row meet a patch that another one met, and sorting
// them all costs more.
void sum_equal_patches(std::vector<FormFactor>& links) {
  thread_local std::vector<uint32_t> slots;  // scratch: index into links of the patch in this slot
  thread_local std::vector<double> sums;
  const size_t slot_count = std::bit_ceil(2 * links.size());
  slots.assign(slot_count, kFree);
  sums.clear();
  for (const FormFactor link : links) {
    // Fibonacci hashing (Knuth, TAOCP 3, 6.4): neighbouring patches spread over the table.
    size_t slot = (link.patch * 0x9e3779b1u) >> 7 & (slot_count - 1);
    while (slots[slot] != kFree && links[slots[slot]].patch != link.patch)
      slot = (slot + 1) & (slot_count - 1);
    if (slots[slot] == kFree) {
      slots[slot] = static_cast<uint32_t>(sums.size());
      links[sums.size()].patch = link.patch;
      sums.push_back(0);
    }
    sums[slots[slot]] += static_cast<double>(link.weight);
  }
  links.resize(sums.size());
  for (size_t i = 0; i < sums.size(); ++i) links[i].weight = static_cast<float>(sums[i]);
}

// So few links are sorted faster one by one, each into its place among those before it.
constexpr size_t kFewLinks = 32;

void combine_few(std::vector<FormFactor>& links) {
  struct Sum {
    uint32_t patch;
    double weight;
  };
  std::array<Sum, kFewLinks> sums;
  size_t count = 0;
  for (const FormFactor link : links) {
    size_t place = count;
    while (place > 0 && sums[place - 1].patch >= link.patch) --place;
    if (place < count && sums[place].patch == link.patch) {
      sums[place].weight += static_cast<double>(link.weight);
      continue;
    }
    std::copy_backward(sums.data() + place, sums.data() + count, sums.data() + count + 1);
    sums[place] = {link.patch, static_cast<double>(link.weight)};
    ++count;
  }
  links.resize(count);
  for (size_t i = 0; i < count; ++i) links[i] = {sums[i].patch, static_cast<float>(sums[i].weight)};
}

}  // namespace

void add_nearest_link(const Surface& surface, glm::dvec2 position, double weight,
                      std::vector<FormFactor>& links) {
  add_link(surface, static_cast<int>(std::floor(position.x + 0.5)),
           static_cast<int>(std::floor(position.y + 0.5)), weight, links);
}

void add_bilinear_links(const Surface& surface, glm::dvec2 position, double weight,
                        std::vector<FormFactor>& links) {
  const int x = static_cast<int>(std::floor(position.x)), y = static_cast<int>(std::floor(position.y));
  const double fx = position.x - x, fy = position.y - y;
  add_link(surface, x, y, weight * (1 - fx) * (1 - fy), links);
  add_link(surface, x + 1, y, weight * fx * (1 - fy), links);
  add_link(surface, x, y + 1, weight * (1 - fx) * fy, links);
  add_link(surface, x + 1, y + 1, weight * fx * fy, links);
}

void add_node_links(const PatchSet& patches, uint32_t facet, glm::dvec2 uv, double distance_texels,
                    double choice, double weight, std::vector<FormFactor>& links) {
  if (distance_texels >= kNear) {
    links.push_back({sample_patch(patches, facet, uv, choice), static_cast<float>(weight)});
    return;
  }
  double parts_left = kNearParts, below = choice;
  const std::array<PatchShare, 3> shares = patch_shares(patches, facet, uv);
  for (size_t i = 0; i < shares.size(); ++i) {
    const double above = below + kNearParts * shares[i].share;
    const double parts =
        i + 1 == shares.size() ? parts_left : std::min(parts_left, std::floor(above) - std::floor(below));
    if (parts > 0) links.push_back({shares[i].patch, static_cast<float>(weight * (parts / kNearParts))});
    parts_left -= parts;
    below = above;
  }
}

void combine_links(std::vector<FormFactor>& links) {
  if (links.size() <= kFewLinks) return combine_few(links);
  sum_equal_patches(links);
  std::sort(links.begin(), links.end(),
            [](const FormFactor& a, const FormFactor& b) { return a.patch < b.patch; });
}

void merge_links(Row& row) {
  if (row.links.empty()) {
    row.direct_over_pi = 1;
    return;
  }
  combine_links(row.links);
  double total = 0;
  FormFactor* largest = &row.links.front();
  for (FormFactor& link : row.links) {
    total += static_cast<double>(link.weight);
    if (link.weight > largest->weight) largest = &link;
  }
  const double missing = 1 - static_cast<double>(static_cast<float>(row.direct_over_pi)) - total;
  largest->weight = static_cast<float>(static_cast<double>(largest->weight) + missing);
}

}  // namespace hemibake
