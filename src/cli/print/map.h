// Prints what a map was understood as, as text and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bake/load.h"

namespace hemibake {

// Returns a line about the heights, and one about a normal map, with their line breaks.
std::string describe_map(const LoadedMap& map);
nlohmann::ordered_json json_from_map(const LoadedMap& map);

// Returns what makes the reading of a map doubtful, with the options of the command line.
std::vector<std::string> warnings_of(const LoadedMap& map);

}  // namespace hemibake
