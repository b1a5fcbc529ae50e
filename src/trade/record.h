// Results of a study as JSON, for its records on disk, its child processes and trade.json.
//
// Found by nlohmann::json: `ordered_json json = run;`, `json.get<ScoredRun>()`. from_json throws
// nlohmann::json::exception where a value is missing or of another type. trade_file.h describes the form.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "trade/reference.h"
#include "trade/scored_run.h"

namespace hemibake {

void to_json(nlohmann::ordered_json& json, const ReferenceFacts& facts);
void from_json(const nlohmann::ordered_json& json, ReferenceFacts& facts);

void to_json(nlohmann::ordered_json& json, const ScoredRun& run);
void from_json(const nlohmann::ordered_json& json, ScoredRun& run);

// Returns {name: value}.
nlohmann::ordered_json json_from_settings(const std::vector<Setting>& settings);

}  // namespace hemibake
