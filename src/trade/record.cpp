#include "trade/record.h"

#include <nlohmann/json.hpp>

namespace hemibake {
namespace {

using nlohmann::ordered_json;

constexpr std::array<const char*, 2> kCurveNames = {"E0", "E1"};

ordered_json json_of(const PlaneValues& values) {
  ordered_json json = ordered_json::object();
  for (size_t p = 0; p < kPlaneCount; ++p) json[named_planes()[p].name] = values[p];
  return json;
}

PlaneValues plane_values_from(const JsonReader& json) {
  PlaneValues values{};
  for (size_t p = 0; p < kPlaneCount; ++p) values[p] = json.at(named_planes()[p].name).number();
  return values;
}

ordered_json json_of(const ErrorStatistics& error) {
  return {{"rmse", error.rmse}, {"bias", error.bias}, {"max", error.largest}, {"p99", error.p99}};
}

ErrorStatistics statistics_from(const JsonReader& json) {
  return {json.at("rmse").number(), json.at("bias").number(), json.at("max").number(),
          json.at("p99").number()};
}

ordered_json json_of(const PlaneErrors& errors) {
  ordered_json json = ordered_json::object();
  for (size_t p = 0; p < kPlaneCount; ++p)
    if (errors[p]) json[named_planes()[p].name] = json_of(*errors[p]);
  return json;
}

PlaneErrors plane_errors_from(const JsonReader& json) {
  PlaneErrors errors;
  for (size_t p = 0; p < kPlaneCount; ++p)
    if (const auto found = json.find(named_planes()[p].name)) errors[p] = statistics_from(*found);
  return errors;
}

ordered_json json_of(const std::optional<CurveErrors>& curves) {
  ordered_json json = ordered_json::object();
  for (size_t c = 0; curves && c < kCurveNames.size(); ++c) {
    const CurveError& error = (*curves)[c];
    json[kCurveNames[c]] = {
        {"bias", error.bias}, {"rms", error.rms}, {"max", error.largest}, {"bins", error.bins}};
  }
  return json;
}

std::optional<CurveErrors> curve_errors_from(const JsonReader& json) {
  if (json.members().empty()) return std::nullopt;
  CurveErrors curves;
  for (size_t c = 0; c < kCurveNames.size(); ++c) {
    const JsonReader curve = json.at(kCurveNames[c]);
    curves[c] = {curve.at("bias").number(), curve.at("rms").number(), curve.at("max").number(),
                 curve.at("bins").whole<int>()};
  }
  return curves;
}

ordered_json json_of(const std::vector<LightModelErrors>& models) {
  ordered_json json = ordered_json::object();
  for (const LightModelErrors& model : models)
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a)
      json[model.model][named_planes()[kLightPlanes + a].name] = json_of(model.error[a]);
  return json;
}

std::vector<LightModelErrors> light_model_errors_from(const JsonReader& json) {
  std::vector<LightModelErrors> models;
  for (const auto& [name, errors] : json.members()) {
    LightModelErrors& model = models.emplace_back(LightModelErrors{name, {}});
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a)
      model.error[a] = statistics_from(errors.at(named_planes()[kLightPlanes + a].name));
  }
  return models;
}

ordered_json json_of(const FittedModels& models) {
  ordered_json json = {{"eq12-refitted", nullptr}, {"bounded", nullptr}};
  if (const auto& m = models.eq12)
    json["eq12-refitted"] = {{"k", m->k}, {"e", m->e}, {"A", m->a}, {"B", m->b}};
  if (const auto& m = models.bounded)
    json["bounded"] = {{"k0", m->k0}, {"k1", m->k1}, {"q", m->q}, {"d", m->d}};
  return json;
}

FittedModels fitted_models_from(const JsonReader& json) {
  FittedModels models;
  const JsonReader eq12 = json.at("eq12-refitted"), bounded = json.at("bounded");
  const auto of = [](const JsonReader& model, const char* name) { return model.at(name).number(); };
  if (!eq12.is_null())
    models.eq12 = Mayaux2018Model{of(eq12, "k"), of(eq12, "e"), of(eq12, "A"), of(eq12, "B")};
  if (!bounded.is_null())
    models.bounded = BoundedModel{of(bounded, "k0"), of(bounded, "k1"), of(bounded, "q"), of(bounded, "d")};
  return models;
}

ordered_json json_of(const std::vector<RefereeRow>& rows) {
  ordered_json json = ordered_json::array();
  for (const RefereeRow& row : rows)
    json.push_back({{"quantity", row.quantity},
                    {"reference", row.bake_mean},
                    {"referee", row.referee_mean},
                    {"bias", row.bias},
                    {"half_width", row.half_width},
                    {"texels", row.texels}});
  return json;
}

std::vector<RefereeRow> referee_rows_from(const JsonReader& json) {
  std::vector<RefereeRow> rows;
  for (const JsonReader& entry : json.elements()) {
    RefereeRow& row = rows.emplace_back();
    row.quantity = entry.at("quantity").text();
    row.bake_mean = entry.at("reference").number();
    row.referee_mean = entry.at("referee").number();
    row.bias = entry.at("bias").number();
    row.half_width = entry.at("half_width").number();
    row.texels = entry.at("texels").whole<size_t>();
  }
  return rows;
}

std::vector<Setting> settings_from(const JsonReader& json) {
  std::vector<Setting> settings;
  if (json.is_null()) return settings;  // as older versions write none
  for (const auto& [name, value] : json.members()) {
    Setting& setting = settings.emplace_back(Setting{name, ""});
    if (value.is_whole())
      setting.value = value.whole<int>();
    else if (value.is_number())
      setting.value = value.number();
    else
      setting.value = value.text();
  }
  return settings;
}

}  // namespace

ordered_json json_from_settings(const std::vector<Setting>& settings) {
  ordered_json json = ordered_json::object();
  for (const Setting& setting : settings)
    std::visit([&](const auto& value) { json[setting.name] = value; }, setting.value);
  return json;
}

void to_json(ordered_json& json, const ReferenceFacts& facts) {
  json = {{"width", facts.width},
          {"height", facts.height},
          {"can_halve", facts.can_halve},
          {"height_range_m", facts.height_range_m},
          {"texel_size_m", facts.texel_size_m},
          {"bounces", facts.bounces},
          {"azimuths_ao", facts.azimuths_ao},
          {"error", json_of(facts.error)},
          {"best_run_error", json_of(facts.best_run_error)},
          {"azimuths_light", facts.azimuths_light},
          {"seeds_light", facts.seeds_light},
          {"mean", json_of(facts.mean)},
          {"referee", json_of(facts.referee)},
          {"models", json_of(facts.models)},
          {"cpu_seconds", facts.cpu_seconds},
          {"models_on_true_ao", json_of(facts.models_on_true_ao)}};
}

ReferenceFacts reference_facts_from(const JsonReader& json) {
  ReferenceFacts facts;
  facts.width = json.at("width").whole<decltype(facts.width)>();
  facts.height = json.at("height").whole<decltype(facts.height)>();
  facts.can_halve = json.at("can_halve").flag();
  facts.height_range_m = json.at("height_range_m").number();
  facts.texel_size_m = json.at("texel_size_m").number();
  facts.bounces = json.at("bounces").whole<decltype(facts.bounces)>();
  facts.azimuths_ao = json.at("azimuths_ao").whole<decltype(facts.azimuths_ao)>();
  facts.error = plane_values_from(json.at("error"));
  facts.best_run_error = plane_values_from(json.at("best_run_error"));
  facts.azimuths_light = json.at("azimuths_light").whole<decltype(facts.azimuths_light)>();
  facts.seeds_light = json.at("seeds_light").whole<decltype(facts.seeds_light)>();
  facts.mean = plane_values_from(json.at("mean"));
  facts.referee = referee_rows_from(json.at("referee"));
  facts.models = fitted_models_from(json.at("models"));
  facts.cpu_seconds = json.at("cpu_seconds").number();
  facts.models_on_true_ao = light_model_errors_from(json.at("models_on_true_ao"));
  return facts;
}

void to_json(ordered_json& json, const ScoredRun& run) {
  json = {{"id", run.id()},
          {"method", run.method},
          {"settings", json_from_settings(run.settings)},
          {"series", run.series},
          {"abscissa", run.abscissa_name},
          {"abscissa_value", run.abscissa},
          {"representative", run.representative},
          {"cpu_seconds", run.cost.cpu_seconds},
          {"wall_seconds", run.cost.wall_seconds},
          {"repeats", run.cost.repeats},
          {"memory_bytes", run.cost.memory_bytes},
          {"work", run.work},
          {"known", run.known},
          {"error", json_of(run.error)},
          {"curve", json_of(run.curve)},
          {"models", json_of(run.models)}};
}

ScoredRun scored_run_from(const JsonReader& json) {
  ScoredRun run;
  run.method = json.at("method").text();
  run.settings = settings_from(json.at("settings"));
  run.series = json.at("series").text();
  run.abscissa_name = json.at("abscissa").text();
  run.abscissa = json.at("abscissa_value").number();
  run.representative = json.at("representative").flag();
  run.cost.cpu_seconds = json.at("cpu_seconds").number();
  run.cost.wall_seconds = json.at("wall_seconds").number();
  run.cost.repeats = json.at("repeats").whole<decltype(run.cost.repeats)>();
  run.cost.memory_bytes = json.at("memory_bytes").whole<decltype(run.cost.memory_bytes)>();
  run.work = json.at("work").whole<decltype(run.work)>();
  run.known = json.at("known").number();
  run.error = plane_errors_from(json.at("error"));
  run.curve = curve_errors_from(json.at("curve"));
  run.models = light_model_errors_from(json.at("models"));
  return run;
}

}  // namespace hemibake
