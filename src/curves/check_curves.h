// What must hold of curves whatever the map.
#pragma once

#include "core/check.h"
#include "curves/curves.h"

namespace hemibake {

// Every bin: mean AO inside the bin, E₀/π between α² and α(2−α), no irradiance outside 0..π, and Σ_b E_b/π not above
// 1 + tolerance. The sum itself, which stays below 1 where bounces are still under way, is judged only if
// `require_whole_energy`: then |Σ − 1| ≤ tolerance.
Checks check_curves(const Curves& curves, double tolerance, bool require_whole_energy);

}  // namespace hemibake
