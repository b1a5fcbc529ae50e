// Prints fits for a person.
#pragma once

#include <span>
#include <string>

#include "fitting/fit.h"
#include "fitting/map_comparison.h"

namespace hemibake {

// Returns the lines of each fit, of at most 80 columns: name and formula, then constants with their errors
// and the residuals.
std::string text_from_fits(std::span<const NamedFit> fits);

// Returns m of a single map; of several their own constants, own and held-out errors, and the winner.
// Tables of at most 100 columns, 80 for the models that are fitted by default. shared: the fits to all maps.
std::string text_from_comparison(const MapComparison& comparison, std::span<const NamedFit> shared);

}  // namespace hemibake
