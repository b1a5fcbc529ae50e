// Solves for light at given albedos: E = E₀ + W diag(albedo) E between the patches, then a final gather at
// the texels.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "transport/links/form_factors.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Light before any bounce, in any unit, 0..: one value per texel and one per patch (if patches are texels,
// the same values twice).
struct DirectLight {
  std::vector<double> texel_light, patch_light;
};

// Returns the light of a uniform sky: E₀/π.
DirectLight uniform_sky(const LightTransport& transport);

struct AlbedoOptions {
  std::optional<int> bounces;  // of the texels' light, 0..; none: until converged
  double tolerance = 1e-6;     // converged: largest error of a patch, over the largest direct light
  int max_products = 2000;     // limit of products of the patch matrix and light, 1..
};

// Irradiance with its bounces, in the unit of the direct light.
struct AlbedoLight {
  std::vector<double> texel_light;
  std::vector<double> patch_light;  // as the texels gathered it: one bounce less
  int products = 0;                 // of the patch matrix and light
  // Converged only: bound of the error of a patch, over the largest direct light. A bound but for the
  // rounding of the products (10⁻¹⁵ of all light). Infinite if a patch could keep light for ever.
  double missing = 0;
};

// Sends light round at an albedo per patch. The same bytes at any thread count.
// final_gather: texel × patch. patch_form_factors: patch × patch (the same matrix if patches are texels).
// albedo: one per patch, 0..1.
AlbedoLight bounce_with_albedo(const FormFactorMatrix& final_gather,
                               const FormFactorMatrix& patch_form_factors, const DirectLight& direct,
                               std::span<const float> albedo, const AlbedoOptions& options);

// Sends the light of a uniform sky round at an albedo per patch, everything over π.
AlbedoLight bounce_with_albedo(const LightTransport& transport, std::span<const float> albedo,
                               const AlbedoOptions& options);

}  // namespace hemibake
