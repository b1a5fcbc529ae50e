// Results of a study as JSON, for its records on disk, its child processes and trade.json.
//
// to_json is found by nlohmann::json: `ordered_json json = run;`. trade_file.h describes the form.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "io/json_reader.h"
#include "trade/reference.h"
#include "trade/scored_run.h"

namespace hemibake {

void to_json(nlohmann::ordered_json& json, const ReferenceFacts& facts);
void to_json(nlohmann::ordered_json& json, const ScoredRun& run);

// Both throw InputError naming the place of a value that is missing or of another type.
ReferenceFacts reference_facts_from(const JsonReader& json);
ScoredRun scored_run_from(const JsonReader& json);

// Returns {name: value}.
nlohmann::ordered_json json_from_settings(const std::vector<Setting>& settings);

}  // namespace hemibake
