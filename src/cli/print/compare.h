// Prints the comparison of candidate models.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "fitting/candidates.h"

namespace hemibake {

struct ComparedCandidate {
  const Candidate* candidate;
  Comparison comparison;
};

// Returns {"models": [{"model", "formula", "parameters", "aicc", "errors": [{"map", "own", "others"}]}]}.
// names: of the maps, in the order of the comparisons.
nlohmann::json json_from_comparisons(std::span<const ComparedCandidate> candidates,
                                     std::span<const std::string> names);

// Returns a table of means, a line for each candidate, and tables of four maps each; at most 100 columns.
// names: as above.
std::string text_from_comparisons(std::span<const ComparedCandidate> candidates,
                                  std::span<const std::string> names);

}  // namespace hemibake
