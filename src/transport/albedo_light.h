// Light going round at given albedos: E = E₀ + W diag(albedo) E between the patches, gathered by the texels.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "transport/links/form_factors.h"
#include "transport/trace_surface.h"

namespace hemibake {

// What arrives before any bounce, in any unit, none negative: one value per texel and one per patch (where
// patches are texels, the same values twice).
struct DirectLight {
  std::vector<double> texel_light, patch_light;
};

// The sky that is the same everywhere: E₀/π.
DirectLight uniform_sky(const LightTransport& seen);

struct AlbedoOptions {
  std::optional<int> bounces;  // of the texels' light, 0..; none: until converged
  double tolerance = 1e-6;     // converged: no patch is further off than this, over the largest direct light
  int max_products = 2000;     // patch matrix times light; the end of it in any case, at least 1
};

// Irradiance with its bounces, in the unit of the direct light; of the patches as the texels gathered it (one
// bounce less).
struct AlbedoLight {
  std::vector<double> texel_light, patch_light;
  int products = 0;  // patch matrix times light
  // Only converged: no patch is further than this from the truth, either way, over the largest direct light:
  // a bound, not an estimate, but for the rounding of the products (10⁻¹⁵ of what light can add up to).
  // Infinite where a patch could keep light for ever.
  double missing = 0;
};

// albedo: one per patch, 0..1. gather: texel × patch; patch_links: patch × patch (the same matrix where
// patches are texels). The same bytes at any thread count.
AlbedoLight bounce_with_albedo(const FormFactorMatrix& final_gather, const FormFactorMatrix& patch_links,
                               const DirectLight& direct, std::span<const float> albedo,
                               const AlbedoOptions& options);

// The same under the uniform sky: everything over π.
AlbedoLight bounce_with_albedo(const LightTransport& seen, std::span<const float> albedo,
                               const AlbedoOptions& options);

}  // namespace hemibake
