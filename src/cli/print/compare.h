// Prints the comparison of candidate models.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "fitting/candidates.h"

namespace hemibake {

struct ComparedMap {
  std::string name;
  std::string path;  // of its curves or its bake
};

struct ComparedCandidate {
  const Candidate* candidate;
  Comparison comparison;
};

// Returns {"models": [{"model", "formula", "parameters", "aicc", "errors": [{"map", "curves", "own",
// "others"}]}]}. maps: in the order of the comparisons.
nlohmann::json json_from_comparisons(std::span<const ComparedCandidate> candidates,
                                     std::span<const ComparedMap> maps);

// Returns a table of means, a line for each candidate, and tables of four maps each; at most 100 columns.
// maps: as above.
std::string text_from_comparisons(std::span<const ComparedCandidate> candidates,
                                  std::span<const ComparedMap> maps);

}  // namespace hemibake
