// Prints fits for a person.
#pragma once

#include <span>
#include <string>

#include "fitting/fit.h"

namespace hemibake {

// Returns two lines for each fit: name and formula, then constants with their errors and the residuals.
std::string text_from_fits(std::span<const NamedFit> fits);

}  // namespace hemibake
