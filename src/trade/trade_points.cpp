#include "trade/trade_points.h"

namespace hemibake {
namespace {

using nlohmann::ordered_json;

constexpr const char* kModel = "bounded";

bool has_bounces(const ordered_json& run) { return run["error"].contains("first"); }

}  // namespace

bool answers(const ordered_json& run, const std::string& plane) {
  const bool is_sky = plane == "ao" || plane == "direct";
  return run["error"].contains(plane) && !(is_sky && has_bounces(run));
}

std::vector<TradePoint> trade_points(const ordered_json& runs, const std::string& plane) {
  std::vector<TradePoint> points;
  const auto add = [&](const ordered_json& run, const char* model, const ordered_json& errors) {
    points.push_back(
        {run["id"], run["method"], model, run["known"], {run["cpu_seconds"], errors[plane]["rmse"]}});
  };
  for (const ordered_json& run : runs) {
    if (answers(run, plane)) add(run, "", run["error"]);
    const ordered_json& models = run["models"];
    if (!has_bounces(run) && models.contains(kModel) && models[kModel].contains(plane))
      add(run, kModel, models[kModel]);
  }
  return points;
}

}  // namespace hemibake
