// Runs a tracer over every texel and every patch of a surface.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

#include "core/grid.h"
#include "tracers/tracer.h"
#include "transport/links/form_factors.h"

namespace hemibake {

// Visibility, direct light and form factors of a surface.
struct LightTransport {
  Grid<float> visible_fraction;   // α per texel
  Grid<float> direct_over_pi;     // E₀/π per texel
  Grid<glm::vec3> bent_normals;   // per texel, unit
  FormFactorMatrix final_gather;  // texel × patch; empty without form factors
  // patch × patch; empty if patches are texels (then final_gather serves for both) and without their form
  // factors
  FormFactorMatrix patch_form_factors;
  std::vector<float>
      patch_direct_over_pi;  // E₀/π per patch; empty if patches are texels and without form factors
  TracerCounts counts;

  // Returns the matrix of one bounce: patch × patch.
  const FormFactorMatrix& bounce_matrix() const {
    return patch_form_factors.empty() ? final_gather : patch_form_factors;
  }
  // Returns E₀/π of every patch.
  const std::vector<float>& patch_direct() const {
    return patch_direct_over_pi.empty() ? direct_over_pi.values : patch_direct_over_pi;
  }
};

// Says what is kept of what texels and patches see: their sky; texels' form factors too, for one bounce;
// or those of patches as well, for any number.
enum class KeptLinks { kNone, kOfTexels, kAll };

// Traces every texel, and every patch unless `kept` is kNone. The same bytes at any thread count. Throws
// Cancelled between blocks of rows. spill: file that form factors go to; none: they stay in memory.
LightTransport trace_surface(const Tracer& tracer, KeptLinks kept,
                             const std::shared_ptr<SpillFile>& spill = nullptr);

}  // namespace hemibake
