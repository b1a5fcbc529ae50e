// Checks the invariants of curves, which hold for any map.
#pragma once

#include "core/check.h"
#include "curves/curves.h"

namespace hemibake {

// Checks every bin: mean index inside it, α² ≤ E₀/π ≤ α(2−α) or E₀/π = V inside it, 0 ≤ E_b ≤ π,
// Σ_b E_b/π ≤ 1 + tolerance.
// require_whole_energy: demands |Σ − 1| ≤ tolerance too; the sum is below 1 while bounces are under way.
Checks check_curves(const Curves& curves, double tolerance, bool require_whole_energy);

}  // namespace hemibake
