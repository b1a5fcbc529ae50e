// A replayed texel as text and as JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "bake/replay.h"

namespace hemibake {

std::string describe_replay(const Replay& replay);
nlohmann::ordered_json json_from_replay(const Replay& replay);

}  // namespace hemibake
