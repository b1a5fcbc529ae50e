#include "trade/trade_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "io/output_file.h"
#include "trade/front.h"
#include "trade/trade_points.h"

namespace hemibake {
namespace {

using nlohmann::ordered_json;

constexpr std::array<const char*, 3> kFrontPlanes = {"ao", "direct", "light.50"};

ordered_json plane_descriptions() {
  ordered_json planes = {{"ao", "uniform visible fraction"},
                         {"direct", "E0/pi, the cosine-weighted visible fraction"},
                         {"first", "E1/pi, one bounce at albedo 1"}};
  for (const NamedPlane& named : named_planes())
    if (named.single == nullptr)
      planes[named.name] = fmt::format("E/pi, all bounces at albedo {:g}", kJudgedAlbedos[named.albedo]);
  return planes;
}

ordered_json front_of(const ordered_json& runs, const std::string& plane) {
  std::vector<TradePoint> points = trade_points(runs, plane);
  // What a method leaves out must not make it look good.
  std::erase_if(points, [](const TradePoint& point) { return point.known < 1; });
  std::vector<CostAndError> values;
  for (const TradePoint& point : points) values.push_back(point.value);
  ordered_json front = ordered_json::array();
  for (const size_t i : pareto_front(values))
    front.push_back({{"id", points[i].id},
                     {"model", points[i].model},
                     {"cpu_seconds", values[i].cpu_seconds},
                     {"rmse", values[i].error}});
  return front;
}

ordered_json series_of(const ordered_json& runs, const std::string& plane) {
  ordered_json all = ordered_json::array();
  std::vector<std::string> names;
  for (const ordered_json& run : runs) {
    const std::string name = run["series"];
    if (name.empty() || !answers(run, plane) || std::ranges::find(names, name) != names.end()) continue;
    names.push_back(name);
    std::vector<double> x, y;
    ordered_json points = ordered_json::array();
    for (const ordered_json& rung : runs) {
      if (rung["series"] != name) continue;
      x.push_back(rung["abscissa_value"]);
      y.push_back(rung["error"][plane]["rmse"]);
      points.push_back({x.back(), y.back()});
    }
    const PowerLaw law = fit_power_law(x, y);
    ordered_json series = {{"name", name}, {"abscissa", run["abscissa"]}, {"plane", plane}};
    series["slope"] = law.points < 2 ? ordered_json(nullptr) : ordered_json(law.slope);
    series["slope_error"] = law.points < 3 ? ordered_json(nullptr) : ordered_json(law.slope_error);
    series["points"] = points;
    all.push_back(series);
  }
  return all;
}

// The reference's error against that of the best of all runs, plane by plane.
ordered_json precision_of(const ordered_json& reference, const ordered_json& runs) {
  ordered_json precision;
  for (const auto& [plane, error] : reference["error"].items()) {
    double best = HUGE_VAL;
    ordered_json entry = {{"error", error}};
    for (const ordered_json& run : runs) {
      if (run["known"].get<double>() < 1 || !run["error"].contains(plane)) continue;
      // What is seen is the run's own error and the reference's, which are independent.
      const double seen = run["error"][plane]["rmse"], own = error;
      const double alone = std::sqrt(std::max(0.0, seen * seen - own * own));
      if (alone >= best) continue;
      best = alone;
      entry["best_error"] = alone;
      entry["best_run"] = run["id"];
    }
    const bool reached = error.get<double>() <= std::max(kReferenceShare * best, 1e-6);
    entry["share"] = best > 0 ? ordered_json(error.get<double>() / best) : ordered_json(nullptr);
    entry["reached"] = reached;
    precision[plane] = entry;
  }
  return precision;
}

std::string settings_text(const ordered_json& settings) {
  std::string text;
  for (const auto& [name, value] : settings.items())
    text += fmt::format("{}{}={}", text.empty() ? "" : " ", name,
                        value.is_string() ? value.get<std::string>() : value.dump());
  return text;
}

constexpr std::array<const char*, 4> kErrorFields = {"rmse", "bias", "max", "p99"};
constexpr std::array<const char*, 3> kCurveFields = {"bias", "rms", "max"};
constexpr std::array<const char*, 2> kCurves = {"E0", "E1"};

// Cells of one line after the first four: costs (null: a model on the truth), then errors.
std::string csv_cells(const ordered_json& run, const ordered_json& errors, const ordered_json& curve) {
  std::string line;
  for (const char* cost : {"cpu_seconds", "wall_seconds", "memory_bytes", "known"})
    line += run.is_null() ? "," : "," + run[cost].dump();
  for (const NamedPlane& named : named_planes())
    for (const char* field : kErrorFields)
      line += errors.contains(named.name) ? "," + errors[named.name][field].dump() : ",";
  for (const char* of : kCurves)
    for (const char* field : kCurveFields) line += curve.contains(of) ? "," + curve[of][field].dump() : ",";
  return line + "\n";
}

}  // namespace

const char* effort_name(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return "quick";
    case Effort::kNormal:
      return "normal";
    default:
      return "full";
  }
}

ordered_json json_from_study(const Study& study, Effort effort, const Provenance& provenance) {
  ordered_json json = {
      {"provenance", provenance}, {"effort", effort_name(effort)}, {"albedos", kJudgedAlbedos}};
  json["planes"] = plane_descriptions();
  json["reference"] = study.reference;
  json["reference"]["precision"] = precision_of(study.reference, study.runs);
  for (const LightModel& model : light_models()) json["models"][model.name] = model.description;
  json["runs"] = study.runs;
  json["series"] = ordered_json::array();
  for (const char* plane : kFrontPlanes) {
    json["fronts"][plane] = front_of(json["runs"], plane);
    for (const ordered_json& series : series_of(json["runs"], plane)) json["series"].push_back(series);
  }
  return json;
}

void write_trade_csv(const std::filesystem::path& path, const ordered_json& json) {
  std::string text = "method,settings,model,representative,cpu_seconds,wall_seconds,memory_bytes,known";
  for (const NamedPlane& named : named_planes())
    for (const char* field : kErrorFields) text += fmt::format(",{}_{}", named.name, field);
  for (const char* of : kCurves)
    for (const char* field : kCurveFields) text += fmt::format(",curve_{}_{}", of, field);
  text += "\n";
  const ordered_json none = ordered_json::object();
  for (const auto& [model, errors] : json["reference"]["models_on_true_ao"].items())
    text += fmt::format("truth,,{},1", model) + csv_cells(nullptr, errors, none);
  for (const ordered_json& run : json["runs"]) {
    const std::string start =
        fmt::format("{},{}", run["method"].get<std::string>(), settings_text(run["settings"]));
    const int representative = run["representative"].get<bool>() ? 1 : 0;
    text += fmt::format("{},,{}", start, representative) + csv_cells(run, run["error"], run["curve"]);
    for (const auto& [model, errors] : run["models"].items())
      text += fmt::format("{},{},{}", start, model, representative) + csv_cells(run, errors, none);
  }
  OutputFile file(path);
  file.write(text);
  file.commit();
}

std::string describe_study(const ordered_json& json) {
  std::string text = fmt::format("{:17} {:32} {:>8} {:>8} {:>16} {:>16} {:>16}\n", "method", "settings",
                                 "cpu-s", "MiB", "ao rmse (bias)", "E0/pi", "E/pi, albedo 0.5");
  const auto cell = [](const ordered_json& errors, const char* plane) {
    if (!errors.contains(plane)) return std::string();
    return fmt::format("{:.4f} ({:+.4f})", errors[plane]["rmse"].get<double>(),
                       errors[plane]["bias"].get<double>());
  };
  for (const ordered_json& run : json["runs"]) {
    if (!run["representative"].get<bool>()) continue;
    text +=
        fmt::format("{:17} {:32} {:8.3f} {:8.1f} {:>16} {:>16} {:>16}\n", run["method"].get<std::string>(),
                    settings_text(run["settings"]), run["cpu_seconds"].get<double>(),
                    run["memory_bytes"].get<double>() / (1 << 20), cell(run["error"], "ao"),
                    cell(run["error"], "direct"), cell(run["error"], "light.50"));
    for (const auto& [model, errors] : run["models"].items())
      text += fmt::format("{:17} {:32} {:8} {:8} {:16} {:16} {:>16}\n", "", "  with " + model, "", "", "", "",
                          cell(errors, "light.50"));
  }
  for (const auto& [model, errors] : json["reference"]["models_on_true_ao"].items())
    text += fmt::format("{:17} {:32} {:8} {:8} {:16} {:16} {:>16}\n", "true ao", "  with " + model, "", "",
                        "", "", cell(errors, "light.50"));
  for (const auto& [plane, precision] : json["reference"]["precision"].items())
    text += fmt::format("reference {:8} off by {:.2g} rms, best run by {:.2g}{}\n", plane,
                        precision["error"].get<double>(), precision.value("best_error", 0.0),
                        precision["reached"].get<bool>() ? "" : ": more than a fifth of it");
  return text;
}

}  // namespace hemibake
