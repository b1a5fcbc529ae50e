// One texel again, ray by ray.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "bake/bake.h"
#include "tracers/tracer.h"

namespace hemibake {

struct Replay {
  int x = 0, y = 0;
  double height_m = 0;  // over the lowest texel
  glm::dvec3 normal{0};
  std::vector<RayRecord> rays;
  Row row;
};

// Traces texel (x, y) as the bake would. Throws InputError where it is not on the map.
Replay replay_texel(const PreparedBake& prepared, int x, int y);

}  // namespace hemibake
