// A bake and its plan as text and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "bake/bake.h"
#include "bake/load.h"
#include "io/provenance.h"

namespace hemibake {

// Names what a person should know before trusting the bake: texels left short and the like.
std::vector<std::string> warnings_of(const BakeResult& result);

// Returns one line about a bake among many, without a line break.
std::string line_of_bake(const MapSettings& map, const BakeResult& result,
                         const std::filesystem::path& output);

std::string describe_bake(const LoadedMap& map, const BakeResult& result);
// provenance: as record_of (bake/record.h).
nlohmann::ordered_json json_from_bake(const LoadedMap& map, const BakeResult& result,
                                      const Provenance& provenance);

std::string describe_plan(const PreparedBake& prepared);
nlohmann::ordered_json json_from_plan(const BakePlan& plan);

}  // namespace hemibake
