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
struct LightTransport {
  Grid<float> visible_fraction;   // α per texel
  Grid<float> direct_over_pi;     // E₀/π per texel
  Grid<glm::vec3> bent_normals;   // per texel, unit
  FormFactorMatrix final_gather;  // texel × patch; empty where form factors were not asked for
  FormFactorMatrix
      patch_form_factors;  // patch × patch; empty where patches are texels: the same as final_gather
  std::vector<float> patch_direct_over_pi;  // E₀/π per patch; empty where patches are texels or without links
  TracerCounts counts;

  // The matrix of one bounce.
  const FormFactorMatrix& bounce_matrix() const {
    return patch_form_factors.empty() ? final_gather : patch_form_factors;
  }
  const std::vector<float>& patch_direct() const {
    return patch_direct_over_pi.empty() ? direct_over_pi.values : patch_direct_over_pi;
  }
};

// Traces every texel, and every patch if `with_links`: only then are form factors kept. The same bytes at any
// thread count. spill: where form factors go that memory does not hold; none: they stay in memory. Throws
// Cancelled between blocks of rows.
LightTransport trace_surface(const Tracer& tracer, bool with_links,
                             const std::shared_ptr<SpillFile>& spill = nullptr);

}  // namespace hemibake
