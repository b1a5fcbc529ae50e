// The runs of a study as points of cost and error, for its fronts and plots.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "trade/front.h"

namespace hemibake {

struct TradePoint {
  std::string id, method;
  std::string model;  // that made E/π of the run's AO; empty: the run itself did
  double known = 1;
  CostAndError value;
};

// Whether a run (of trade.json) is to be judged by this plane: a run that goes on to bounces pays for them,
// and its α and E₀/π are those of the run without, which is in the study too.
bool answers(const nlohmann::ordered_json& run, const std::string& plane);

// Runs that answer; for E/π also those that have an AO only, by way of the bounded model.
std::vector<TradePoint> trade_points(const nlohmann::ordered_json& runs, const std::string& plane);

}  // namespace hemibake
