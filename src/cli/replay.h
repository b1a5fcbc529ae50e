// One texel again, ray by ray.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/bake_job.h"
#include "tracers/tracer.h"

namespace hemibake {

struct Replay {
  int x = 0, y = 0;
  double height_m = 0;
  glm::dvec3 normal{0};
  std::vector<RayRecord> rays;
  Row row;
};

// Throws InputError where the texel is not on the map.
Replay replay_texel(const BakeJob& job, int x, int y);

std::string describe_replay(const Replay& replay);
nlohmann::ordered_json json_from_replay(const Replay& replay);

}  // namespace hemibake
