#include "transport/baked_planes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/constants.h"

namespace hemibake {
namespace {

// Values of every plane in one texel.
struct TexelValues {
  float fraction, direct, bounce, total, residual;
  glm::vec3 normal;
};

void set_texel(const TexelValues& values, size_t texel, Bake& bake) {
  const auto set = [texel](auto& plane, const auto& value) {
    if (!plane.empty()) plane[texel] = value;
  };
  set(bake.visible_fraction, values.fraction);
  set(bake.visibility, values.fraction);
  for (size_t b = 0; b < bake.irradiance.size(); ++b)
    set(bake.irradiance[b], b == 0 ? values.direct : values.bounce);
  set(bake.total, values.total);
  set(bake.residual, values.residual);
  set(bake.bounce, values.fraction);
  set(bake.normals, values.normal);
  set(bake.bent_normals, values.normal);
}

}  // namespace

bool is_hole(const Bake& bake, size_t texel) {
  bool has_planes = false;
  const auto is_missing = [&](const auto& plane) {
    if (plane.empty()) return true;
    has_planes = true;
    if constexpr (std::is_same_v<std::decay_t<decltype(plane)>, Grid<glm::vec3>>)
      return std::isnan(plane[texel].x) && std::isnan(plane[texel].y) && std::isnan(plane[texel].z);
    else
      return std::isnan(plane[texel]);
  };
  return is_missing(bake.visible_fraction) && is_missing(bake.visibility) &&
         std::ranges::all_of(bake.irradiance, is_missing) && is_missing(bake.total) &&
         is_missing(bake.residual) && is_missing(bake.bounce) && is_missing(bake.normals) &&
         is_missing(bake.bent_normals) && has_planes;
}

Grid<uint8_t> holes_of(const Bake& bake) {
  Grid<uint8_t> holes(bake.width, bake.height, 0);
  bool any = false;
  for (size_t i = 0; i < holes.size(); ++i) {
    holes[i] = is_hole(bake, i) ? 1 : 0;
    any = any || holes[i] != 0;
  }
  return any ? holes : Grid<uint8_t>();
}

void clear_holes(const Grid<uint8_t>& holes, Bake& bake) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  for (size_t i = 0; i < holes.size(); ++i)
    if (holes[i] != 0) set_texel({kNone, kNone, kNone, kNone, kNone, glm::vec3(kNone)}, i, bake);
}

void show_holes_as_open_ground(Bake& bake) {
  constexpr float kSky = static_cast<float>(kPi);
  const Grid<uint8_t> holes = holes_of(bake);
  for (size_t i = 0; i < holes.size(); ++i)
    if (holes[i] != 0) set_texel({1, kSky, 0, kSky, 0, {0, 0, 1}}, i, bake);
}

}  // namespace hemibake
