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

// Returns {"models": [{"model", "formula", "parameters", "aicc", "errors": [{"curves", "own", "others"}]}]}.
// paths: of the curves, in the order of the comparisons.
nlohmann::json json_from_comparisons(std::span<const ComparedCandidate> candidates,
                                     std::span<const std::string> paths);

// Returns a table, a line for each candidate. paths: as above.
std::string text_from_comparisons(std::span<const ComparedCandidate> candidates,
                                  std::span<const std::string> paths);

}  // namespace hemibake
