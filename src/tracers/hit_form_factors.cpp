#include "tracers/hit_form_factors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "surface/facets.h"

namespace hemibake {
namespace {

void add_texel(const Surface& surface, int x, int y, double weight, std::vector<FormFactor>& form_factors) {
  if (weight <= 0) return;
  const int i = wrap_or_clamp(x, surface.width(), surface.edge),
            j = wrap_or_clamp(y, surface.height(), surface.edge);
  form_factors.push_back({static_cast<uint32_t>(surface.heights_m.index(i, j)), static_cast<float>(weight)});
}

constexpr uint32_t kFree = 0xffffffff;

// Texels: a nearer hit is shared among all nodes around it. The distance of the nodes of a long facet; in a
// deep fold most rays hit nearer.
constexpr double kNear = 0.25;
// A near hit is shared in whole parts, so that rows of hits of equal weight are stored exactly
// (transport/links/form_factors.h). With eighths deep pits kept their light at 32 rays.
constexpr double kNearParts = 16;

// Leaves each patch once, in order of its first form factor, with weights summed in double in their order.
// Uses a hash table: most rays of a row meet a patch that another one met, and sorting them all costs more.
void sum_equal_patches(std::vector<FormFactor>& form_factors) {
  thread_local std::vector<uint32_t> slots;  // scratch: index of the patch in this slot
  thread_local std::vector<double> sums;
  const size_t slot_count = std::bit_ceil(2 * form_factors.size());
  slots.assign(slot_count, kFree);
  sums.clear();
  for (const FormFactor form_factor : form_factors) {
    // Fibonacci hashing (Knuth, TAOCP 3, 6.4): neighbouring patches spread over the table.
    size_t slot = (form_factor.patch * 0x9e3779b1u) >> 7 & (slot_count - 1);
    while (slots[slot] != kFree && form_factors[slots[slot]].patch != form_factor.patch)
      slot = (slot + 1) & (slot_count - 1);
    if (slots[slot] == kFree) {
      slots[slot] = static_cast<uint32_t>(sums.size());
      form_factors[sums.size()].patch = form_factor.patch;
      sums.push_back(0);
    }
    sums[slots[slot]] += static_cast<double>(form_factor.weight);
  }
  form_factors.resize(sums.size());
  for (size_t i = 0; i < sums.size(); ++i) form_factors[i].weight = static_cast<float>(sums[i]);
}

// Up to this many form factors, insertion sort is faster than the hash table.
constexpr size_t kFewFormFactors = 32;

void merge_few(std::vector<FormFactor>& form_factors) {
  struct Sum {
    uint32_t patch;
    double weight;
  };
  std::array<Sum, kFewFormFactors> sums;
  size_t count = 0;
  for (const FormFactor form_factor : form_factors) {
    size_t place = count;
    while (place > 0 && sums[place - 1].patch >= form_factor.patch) --place;
    if (place < count && sums[place].patch == form_factor.patch) {
      sums[place].weight += static_cast<double>(form_factor.weight);
      continue;
    }
    std::copy_backward(sums.data() + place, sums.data() + count, sums.data() + count + 1);
    sums[place] = {form_factor.patch, static_cast<double>(form_factor.weight)};
    ++count;
  }
  form_factors.resize(count);
  for (size_t i = 0; i < count; ++i) form_factors[i] = {sums[i].patch, static_cast<float>(sums[i].weight)};
}

// Spreads the form factors of a hit from `begin` on that lead to a hole over the others. The facet's own
// corners are none, but the fourth of its cell may be.
void leave_out_holes(const Surface& surface, const FacetHit& hit, size_t begin,
                     std::vector<FormFactor>& form_factors) {
  const auto first = form_factors.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto last = std::remove_if(first, form_factors.end(),
                                   [&](const FormFactor& link) { return surface.is_hole(link.patch); });
  if (last == form_factors.end()) return;
  form_factors.erase(last, form_factors.end());
  const glm::ivec2 corner = facet_corners(surface, hit.facet).texel[1];
  if (form_factors.size() == begin) return add_texel(surface, corner.x, corner.y, hit.weight, form_factors);
  double left = 0;
  for (size_t i = begin; i < form_factors.size(); ++i) left += static_cast<double>(form_factors[i].weight);
  for (size_t i = begin; i < form_factors.size(); ++i)
    form_factors[i].weight =
        static_cast<float>(static_cast<double>(form_factors[i].weight) * hit.weight / left);
}

}  // namespace

void add_nearest_form_factor(const Surface& surface, glm::dvec2 position, double weight,
                             std::vector<FormFactor>& form_factors) {
  add_texel(surface, static_cast<int>(std::floor(position.x + 0.5)),
            static_cast<int>(std::floor(position.y + 0.5)), weight, form_factors);
}

void add_bilinear_form_factors(const Surface& surface, glm::dvec2 position, double weight,
                               std::vector<FormFactor>& form_factors) {
  const int x = static_cast<int>(std::floor(position.x)), y = static_cast<int>(std::floor(position.y));
  const double fx = position.x - x, fy = position.y - y;
  add_texel(surface, x, y, weight * (1 - fx) * (1 - fy), form_factors);
  add_texel(surface, x + 1, y, weight * fx * (1 - fy), form_factors);
  add_texel(surface, x, y + 1, weight * (1 - fx) * fy, form_factors);
  add_texel(surface, x + 1, y + 1, weight * fx * fy, form_factors);
}

void add_node_form_factors(const PatchSet& patch_set, const FacetHit& hit, double u,
                           std::vector<FormFactor>& form_factors) {
  if (hit.distance_texels >= kNear) {
    form_factors.push_back({sample_patch(patch_set, hit.facet, hit.uv, u), static_cast<float>(hit.weight)});
    return;
  }
  double parts_left = kNearParts, below = u;
  const std::array<PatchShare, 3> shares = patch_shares(patch_set, hit.facet, hit.uv);
  for (size_t i = 0; i < shares.size(); ++i) {
    const double above = below + kNearParts * shares[i].share;
    const double parts =
        i + 1 == shares.size() ? parts_left : std::min(parts_left, std::floor(above) - std::floor(below));
    if (parts > 0)
      form_factors.push_back({shares[i].patch, static_cast<float>(hit.weight * (parts / kNearParts))});
    parts_left -= parts;
    below = above;
  }
}

void add_form_factors(const Surface& surface, const PatchSet& patch_set, TexelLinks texel_links,
                      const FacetHit& hit, double u, std::vector<FormFactor>& form_factors) {
  const size_t before = form_factors.size();
  if (patch_set.kind == PatchKind::kFacets) {
    add_node_form_factors(patch_set, hit, u, form_factors);
  } else if (texel_links == TexelLinks::kNearest) {
    add_nearest_form_factor(surface, facet_point_texels(surface, hit.facet, hit.uv), hit.weight,
                            form_factors);
  } else {
    add_bilinear_form_factors(surface, facet_point_texels(surface, hit.facet, hit.uv), hit.weight,
                              form_factors);
  }
  if (patch_set.kind == PatchKind::kTexels && !surface.holes.empty())
    leave_out_holes(surface, hit, before, form_factors);
}

void add_own_form_factor(const Surface& surface, const PatchSet& patch_set, uint32_t receiver, bool is_patch,
                         double weight, std::vector<FormFactor>& form_factors) {
  uint32_t patch = receiver;
  if (!is_patch && patch_set.kind == PatchKind::kFacets) {
    const uint32_t width = static_cast<uint32_t>(surface.width()), columns = patch_set.columns;
    const uint32_t x = receiver % width, y = receiver / width, rows = facet_count(surface) / 2 / columns;
    // The last texels of an open map are no first corner of a cell.
    const uint32_t i = std::min(x, columns - 1), j = std::min(y, rows - 1);
    const bool opposite = x > i && y > j;
    const glm::dvec2 uv = opposite ? glm::dvec2(0) : glm::dvec2(x - i, y - j);
    patch = sample_patch(patch_set, 2 * (j * columns + i) + (opposite ? 1 : 0), uv, 0.5);
  }
  form_factors.push_back({patch, static_cast<float>(weight)});
}

void merge_form_factors(std::vector<FormFactor>& form_factors) {
  if (form_factors.size() <= kFewFormFactors) return merge_few(form_factors);
  sum_equal_patches(form_factors);
  std::sort(form_factors.begin(), form_factors.end(),
            [](const FormFactor& a, const FormFactor& b) { return a.patch < b.patch; });
}

void complete_row(Row& row) {
  if (row.links.empty()) {
    row.direct_over_pi = 1;
    return;
  }
  merge_form_factors(row.links);
  double total = 0;
  FormFactor* largest = &row.links.front();
  for (FormFactor& form_factor : row.links) {
    total += static_cast<double>(form_factor.weight);
    if (form_factor.weight > largest->weight) largest = &form_factor;
  }
  const double missing = 1 - static_cast<double>(static_cast<float>(row.direct_over_pi)) - total;
  largest->weight = static_cast<float>(static_cast<double>(largest->weight) + missing);
}

}  // namespace hemibake
