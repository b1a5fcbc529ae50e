#include "lighting/albedo.h"

#include <fmt/format.h>

#include "core/color.h"
#include "core/error.h"
#include "surface/facets.h"

namespace hemibake {

Albedo make_albedo_map(Grid<glm::vec3> reflectance, AlbedoEncoding encoding) {
  const auto width = static_cast<size_t>(reflectance.width);
  for (size_t i = 0; i < reflectance.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      float& value = reflectance[i][c];
      if (!(value >= 0 && value <= 1))
        throw InputError(
            fmt::format("reflectance {} at texel {},{}, expected 0..1", value, i % width, i / width));
      if (encoding == AlbedoEncoding::kSrgb)
        value = static_cast<float>(linear_from_srgb(static_cast<double>(value)));
    }
  return {glm::vec3(0), std::move(reflectance)};
}

std::vector<glm::vec3> albedo_of_patches(const Surface& surface, const Albedo& albedo,
                                         const PatchSet& patches) {
  std::vector<glm::vec3> values(patches.count, albedo.constant);
  if (albedo.map.empty()) return values;
  if (patches.kind == PatchKind::kTexels) return albedo.map.values;
  for (uint32_t patch = 0; patch < patches.count; ++patch) {
    const FacetNode node = facet_node(patches, patch);
    const glm::dvec2 uv = node_uv(node.node);
    const auto corners = facet_corners(surface, node.facet).texel;
    const auto at = [&](int c) {
      return glm::dvec3(albedo.map(corners[c].x % surface.width(), corners[c].y % surface.height()));
    };
    values[patch] = glm::vec3((1 - uv.x - uv.y) * at(0) + uv.x * at(1) + uv.y * at(2));
  }
  return values;
}

}  // namespace hemibake
