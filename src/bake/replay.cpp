#include "bake/replay.h"

#include <fmt/format.h>

#include "core/error.h"

namespace hemibake {

Replay replay_texel(const PreparedBake& prepared, int x, int y) {
  const Surface& surface = prepared.map->surface;
  if (x < 0 || y < 0 || x >= surface.width() || y >= surface.height())
    throw InputError(fmt::format("there is no texel {},{}, expected 0,0 to {},{}", x, y, surface.width() - 1,
                                 surface.height() - 1));
  Replay replay;
  replay.x = x;
  replay.y = y;
  replay.height_m = static_cast<double>(surface.heights_m(x, y));
  replay.normal = glm::dvec3(surface.normals(x, y));
  const uint32_t texel = static_cast<uint32_t>(surface.heights_m.index(x, y));
  TracerCounts counts;
  prepared.tracer->trace_texel(texel, true, replay.row, counts);
  replay.rays = prepared.tracer->replay_texel(texel);
  return replay;
}

}  // namespace hemibake
