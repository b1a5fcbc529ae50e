// The referee's findings as a table and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reference/comparison.h"

namespace hemibake {

std::string table_from_referee(const RefereeCheck& check);
nlohmann::ordered_json json_from_referee(const RefereeCheck& check);

}  // namespace hemibake
