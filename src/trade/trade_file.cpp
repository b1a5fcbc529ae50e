#include "trade/trade_file.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/output_file.h"
#include "trade/analysis.h"
#include "trade/error_picture.h"
#include "trade/record.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json front_json(const std::vector<ScoredRun>& runs, size_t plane) {
  ordered_json front = ordered_json::array();
  for (const FrontPoint& point : front_of(runs, plane))
    front.push_back({{"id", point.id},
                     {"model", point.model},
                     {"cpu_seconds", point.value.cpu_seconds},
                     {"rmse", point.value.error}});
  return front;
}

ordered_json series_json(const Series& series, const std::string& plane) {
  const PowerLaw& law = series.law;
  ordered_json json = {{"name", series.name}, {"abscissa", series.abscissa_name}, {"plane", plane}};
  json["slope"] = law.points < 2 ? ordered_json(nullptr) : ordered_json(law.slope);
  json["slope_error"] = law.points < 3 ? ordered_json(nullptr) : ordered_json(law.slope_error);
  json["points"] = series.points;
  return json;
}

ordered_json precision_json(const Study& study) {
  const auto precision = precision_of(study.reference.error, study.runs);
  ordered_json json;
  for (size_t p = 0; p < kPlaneCount; ++p) {
    const PlanePrecision& plane = precision[p];
    ordered_json& entry = json[named_planes()[p].name];
    entry = {{"error", plane.error}};
    if (plane.best_run) {
      entry["best_error"] = plane.best_error;
      entry["best_run"] = plane.best_run->id();
    }
    entry["share"] = plane.best_error > 0 ? ordered_json(plane.error / plane.best_error) : nullptr;
    entry["reached"] = plane.reached;
  }
  return json;
}

ordered_json pictures_json(const std::vector<ScoredRun>& runs, const fs::path& folder) {
  ordered_json pictures = ordered_json::array();
  for (const ScoredRun& run : runs) {
    for (const size_t p : kFrontPlanes) {
      const std::string& plane = named_planes()[p].name;
      const std::string name = fmt::format("errors/{}-{}.png", run.id(), plane);
      if (std::error_code not_there; fs::exists(folder / name, not_there))
        pictures.push_back(
            {{"file", name},
             {"title", fmt::format("{}: error of {}, blue -0.1 to red +0.1", run.id(), plane)}});
    }
  }
  return pictures;
}

// Writes a double as JSON does: "1.0", shortest that reads back.
std::string text_of(double value) { return ordered_json(value).dump(); }

std::string cells_of(const ErrorStatistics& error) {
  return fmt::format(",{},{},{},{}", text_of(error.rmse), text_of(error.bias), text_of(error.largest),
                     text_of(error.p99));
}

// Returns the cells of a model's line after its costs: no errors but of the light.
std::string cells_of(const LightModelErrors& model) {
  std::string line(4 * kLightPlanes, ',');
  for (const ErrorStatistics& error : model.error) line += cells_of(error);
  return line + ",,,,,,\n";
}

std::string cells_of(const RunCost& cost, double known) {
  return fmt::format(",{},{},{},{}", text_of(cost.cpu_seconds), text_of(cost.wall_seconds), cost.memory_bytes,
                     text_of(known));
}

std::string cells_of(const ScoredRun& run) {
  std::string line = cells_of(run.cost, run.known);
  for (const std::optional<ErrorStatistics>& error : run.error) line += error ? cells_of(*error) : ",,,,";
  if (!run.curve) return line + ",,,,,,\n";
  for (const CurveError& error : *run.curve)
    line += fmt::format(",{},{},{}", text_of(error.bias), text_of(error.rms), text_of(error.largest));
  return line + "\n";
}

std::string csv_header() {
  std::string text = "method,settings,model,representative,cpu_seconds,wall_seconds,memory_bytes,known";
  for (const NamedPlane& named : named_planes())
    for (const char* field : {"rmse", "bias", "max", "p99"}) text += fmt::format(",{}_{}", named.name, field);
  for (const char* curve : {"E0", "E1"})
    for (const char* field : {"bias", "rms", "max"}) text += fmt::format(",curve_{}_{}", curve, field);
  return text + "\n";
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

ordered_json json_from_study(const Study& study, Effort effort, const Provenance& provenance,
                             const fs::path& folder) {
  ordered_json json = {
      {"provenance", provenance}, {"effort", effort_name(effort)}, {"albedos", kJudgedAlbedos}};
  for (const NamedPlane& named : named_planes()) json["planes"][named.name] = named.description;
  json["reference"] = study.reference;
  json["reference"]["precision"] = precision_json(study);
  for (const LightModel& model : light_models()) json["models"][model.name] = model.description;
  json["runs"] = study.runs;
  json["series"] = ordered_json::array();
  for (const size_t plane : kFrontPlanes) {
    json["fronts"][named_planes()[plane].name] = front_json(study.runs, plane);
    for (const Series& series : series_of(study.runs, plane))
      json["series"].push_back(series_json(series, named_planes()[plane].name));
  }
  json["pictures"] = pictures_json(study.runs, folder);
  return json;
}

void write_trade_csv(OutputFile& file, const Study& study) {
  std::string text = csv_header();
  for (const LightModelErrors& model : study.reference.models_on_true_ao)
    text += fmt::format("truth,,{},1,,,,", model.model) + cells_of(model);
  for (const ScoredRun& run : study.runs) {
    const std::string start = fmt::format("{},{}", run.method, run.settings_text());
    const int representative = run.representative ? 1 : 0;
    text += fmt::format("{},,{}", start, representative) + cells_of(run);
    for (const LightModelErrors& model : run.models)
      text += fmt::format("{},{},{}", start, model.model, representative) + cells_of(run.cost, run.known) +
              cells_of(model);
  }
  file.write(text);
}

}  // namespace hemibake
