#include "surface/patches.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/error.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

double longest_edge_texels(const Surface& surface, uint32_t facet) {
  const auto p = facet_positions_texels(surface, facet);
  return std::max({glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
}

int subdivision_for(double longest_edge) {
  return static_cast<int>(std::clamp(std::ceil(longest_edge / kLongestPatchEdge), 1.0,
                                     static_cast<double>(kMaxSubdivision)));
}

// Index of the node at column a of row b, in units of 1/k.
uint32_t node_index(int k, int a, int b) { return static_cast<uint32_t>(b * (k + 1) - b * (b - 1) / 2 + a); }

}  // namespace

PatchSet make_patches(const Surface& surface, Patches kind) {
  PatchSet patches;
  patches.kind = kind;
  if (kind == Patches::kTexels) {
    patches.count = surface.texel_count();
    return patches;
  }
  const uint32_t facets = facet_count(surface);
  patches.first.resize(size_t{facets} + 1);
  uint64_t count = 0;
  for (uint32_t facet = 0; facet < facets; ++facet) {
    patches.first[facet] = static_cast<uint32_t>(count);
    count += node_count(subdivision_for(longest_edge_texels(surface, facet)));
    if (count > std::numeric_limits<uint32_t>::max())
      throw InputError("more patches than links can tell apart, expected a smaller map or --patches texels");
  }
  patches.first[facets] = patches.count = static_cast<uint32_t>(count);
  return patches;
}

int subdivision(const PatchSet& patches, uint32_t facet) {
  const uint32_t nodes = patches.first[facet + 1] - patches.first[facet];
  int k = 1;
  while (node_count(k) < nodes) ++k;
  return k;
}

FacetNode facet_node(const PatchSet& patches, uint32_t patch) {
  const auto after = std::upper_bound(patches.first.begin(), patches.first.end(), patch);
  const auto facet = static_cast<uint32_t>(after - patches.first.begin() - 1);
  const int k = subdivision(patches, facet);
  int a = static_cast<int>(patch - patches.first[facet]), b = 0;
  while (a > k - b) a -= k - b++ + 1;
  return {facet, k, glm::dvec2(a, b) / static_cast<double>(k)};
}

uint32_t draw_patch(const PatchSet& patches, uint32_t facet, glm::dvec2 uv, double choice) {
  const int k = subdivision(patches, facet);
  const double u = std::clamp(uv.x, 0.0, 1.0) * k, v = std::clamp(uv.y, 0.0, 1.0) * k;
  const int a = std::min(static_cast<int>(u), k - 1), b = std::min(static_cast<int>(v), k - 1 - a);
  const double fu = u - a, fv = std::clamp(v - b, 0.0, 1.0);
  const uint32_t first = patches.first[facet];
  // The half of the little square at (a, b) that is a triangle like the facet, or the other way round. Beyond
  // the long side, by rounding, there is only the first kind.
  if (fu + fv <= 1 || a + b == k - 1) {
    if (choice < fu) return first + node_index(k, a + 1, b);
    return first + (choice < fu + fv ? node_index(k, a, b + 1) : node_index(k, a, b));
  }
  if (choice < 1 - fu) return first + node_index(k, a, b + 1);
  return first + (choice < 2 - fu - fv ? node_index(k, a + 1, b) : node_index(k, a + 1, b + 1));
}

double node_area_share(const FacetNode& node) {
  // Every little triangle around the node adds a third of its area: six inside, three along a side, one at a
  // corner of the facet.
  const int k = node.subdivision;
  const int a = static_cast<int>(std::lround(node.uv.x * k)), b = static_cast<int>(std::lround(node.uv.y * k));
  const int sides = (a == 0) + (b == 0) + (a + b == k);
  return (sides == 0 ? 6 : sides == 1 ? 3 : 1) / (3.0 * k * k);
}

glm::dvec2 patch_position_texels(const Surface& surface, const PatchSet& patches, uint32_t patch) {
  if (patches.kind == Patches::kTexels) {
    const uint32_t width = static_cast<uint32_t>(surface.width());
    return {patch % width, patch / width};
  }
  const FacetNode node = facet_node(patches, patch);
  return facet_point_texels(surface, node.facet, node.uv);
}

}  // namespace hemibake
