// Checks that hold of a bake whatever the map: light is neither made nor lost.
#pragma once

#include <optional>

#include "core/check.h"
#include "surface/patches.h"
#include "surface/surface.h"
#include "transport/baked_planes.h"
#include "transport/trace_surface.h"

namespace hemibake {

// Measured while the links are there; kept with the bake.
struct LinkEnergy {
  double row_sum_error = 0;  // largest |Σ_j w_ij + E₀(i)/π − 1| of any row
  // Facets of a tiled map only: Σ area · E₀/π over the facets, over the opening; 1 for the exact surface.
  std::optional<double> light_over_opening;
  double light_over_opening_stderr = 0;  // of rays taken as random ones: an upper bound for ours
};
LinkEnergy measure_link_energy(const Surface& surface, const PatchSet& patches, const LightTransport& seen);

struct BakeCheckOptions {
  // Largest |Σ_b E_b/π − 1| of a texel. Absent: what the bake itself says is still under way may be missing.
  std::optional<double> energy_tolerance;
  double bounds_tolerance = 1e-5;         // of α² ≤ E₀/π ≤ α(2−α)
  std::optional<LinkEnergy> link_energy;  // as stored with the bake
  bool tiled_with_own_normals = true;     // Σ (E₀/π)/n_z is then worth showing
  int bins = 100;
};

// Checks every plane that is there. Unjudged lines (infinite tolerance) inform.
Checks check_bake(const Bake& bake, const BakeCheckOptions& options);

}  // namespace hemibake
