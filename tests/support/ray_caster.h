// Casts rays over a height map, to judge the tracers: in double precision, over one triangle after another,
// without any tree. Slow and simple.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <optional>

#include "surface/facets.h"
#include "surface/surface.h"

namespace hemibake {

struct CastHit {
  uint32_t facet;
  double distance_texels;
};

// Follows a ray over a wrapping map; nullopt: sky. start: texels, centres at integers, z in texels.
inline std::optional<CastHit> cast_ray(const Surface& surface, glm::dvec3 start, glm::dvec3 direction,
                                       double longest_texels = 1e6) {
  const double top = height_range_m(surface) / surface.texel_size_m;
  const double speed[3] = {direction.x, direction.y, direction.x + direction.y};
  const double place[3] = {start.x, start.y, start.x + start.y};
  // Returns the next crossing of lines x = n, y = n, x + y = n (the diagonals).
  const auto next_crossing = [&](double t) {
    double next = HUGE_VAL;
    for (int k = 0; k < 3; ++k) {
      if (speed[k] == 0) continue;
      const double now = place[k] + t * speed[k];
      double line = speed[k] > 0 ? std::floor(now) + 1 : std::ceil(now) - 1;
      double crossing = (line - place[k]) / speed[k];
      while (crossing <= t * (1 + 1e-14)) {
        line += speed[k] > 0 ? 1 : -1;
        crossing = (line - place[k]) / speed[k];
      }
      next = std::min(next, crossing);
    }
    return next;
  };
  for (double t = 0; t < longest_texels;) {
    if (direction.z >= 0 && start.z + t * direction.z > top) return std::nullopt;
    double end = next_crossing(t);
    if (!std::isfinite(end)) end = t + 1;  // straight up or down: stays over one triangle
    const double middle = 0.5 * (t + end);
    const double x = start.x + middle * direction.x, y = start.y + middle * direction.y;
    const double cell_x = std::floor(x), cell_y = std::floor(y);
    const int i = wrap_index(static_cast<int>(cell_x), surface.width());
    const int j = wrap_index(static_cast<int>(cell_y), surface.height());
    const uint32_t facet =
        2 * static_cast<uint32_t>(surface.heights_m.index(i, j)) + (x - cell_x + y - cell_y > 1 ? 1 : 0);
    const auto corners = facet_positions_texels(surface, facet);
    const double leg = facet % 2 == 0 ? 1 : -1;
    const double base_x = cell_x + (facet % 2), base_y = cell_y + (facet % 2);
    const auto gap = [&](double s) {
      const double px = start.x + s * direction.x, py = start.y + s * direction.y;
      return start.z + s * direction.z -
             (corners[0].z + leg * ((corners[1].z - corners[0].z) * (px - base_x) +
                                    (corners[2].z - corners[0].z) * (py - base_y)));
    };
    const double gap_begin = gap(t), gap_end = gap(end);
    if (gap_begin < 0) return CastHit{facet, t};
    if (gap_end < 0) return CastHit{facet, t + (end - t) * gap_begin / (gap_begin - gap_end)};
    t = end;
  }
  return std::nullopt;
}

}  // namespace hemibake
