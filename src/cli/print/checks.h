// Checks as a table for people and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "core/check.h"

namespace hemibake {

std::string table_from_checks(const Checks& checks);
// {"passed": bool, "checks": [{"quantity", "value", "expected", "tolerance" (null: not judged), "passed",
// "detail"}]}
nlohmann::ordered_json json_from_checks(const Checks& checks);

}  // namespace hemibake
