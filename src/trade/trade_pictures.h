// The plots of a study.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace hemibake {

// Writes time-PLANE.svg (error against CPU seconds, the Pareto front marked) for "ao", "direct" and
// "light.50", convergence-PLANE.svg (error against rays, azimuths or taps, with fitted slopes), and returns
// "pictures" of trade.json: these, and the error maps that are in FOLDER/errors. json: of json_from_study.
nlohmann::ordered_json write_trade_pictures(const std::filesystem::path& folder,
                                            const nlohmann::ordered_json& json);

}  // namespace hemibake
