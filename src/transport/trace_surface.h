// Runs a tracer over every texel and every patch of a surface.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "core/grid.h"
#include "tracers/tracer.h"
#include "transport/links/form_factors.h"

namespace hemibake {

// What the surface sees before any light is bounced.
struct Visibility {
  Grid<float> visible_fraction;  // α per texel
  Grid<float> direct_over_pi;    // E₀/π per texel
  Grid<glm::vec3> bent_normals;  // per texel, unit
  Links gather;                  // texel × patch; empty where links were not asked for
  Links patches;  // patch × patch; empty where patches are texels: `gather` is the same matrix
  std::vector<float> patch_direct_over_pi;  // E₀/π per patch; empty where patches are texels or without links
  TracerCounts counts;

  const Links& patch_links() const { return patches.empty() ? gather : patches; }
  const std::vector<float>& patch_direct() const {
    return patch_direct_over_pi.empty() ? direct_over_pi.values : patch_direct_over_pi;
  }
};

// width × height: of the map the tracer was made for. Links are built only if `with_links`. The same bytes at
// any thread count. spill: where links go that memory does not hold; none: they stay in memory. Throws
// Interrupted between blocks of rows.
Visibility trace_surface(const Tracer& tracer, int width, int height, Patches patches, bool with_links,
                         const std::shared_ptr<SpillFile>& spill = nullptr);

}  // namespace hemibake
