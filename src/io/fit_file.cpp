#include "io/fit_file.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/printable.h"
#include "core/version.h"
#include "io/json_reader.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

using Json = nlohmann::ordered_json;

Json json_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json_from_fit(const Fit& fit) {
  Json parameters = Json::object();
  for (const FitParameter& parameter : fit.parameters) {
    Json& json = parameters[parameter.name];
    json = {{"value", parameter.value}, {"stderr", json_or_null(parameter.standard_error)}};
    if (parameter.on_bound) json["on_bound"] = true;
  }
  const size_t count = fit.parameters.size();
  Json covariance = Json::array();
  for (size_t row = 0; row < count; ++row) {
    const auto begin = fit.covariance.begin() + static_cast<ptrdiff_t>(row * count);
    covariance.push_back(std::vector<double>(begin, begin + static_cast<ptrdiff_t>(count)));
  }
  return {{"model", fit.model},
          {"formula", fit.formula},
          {"parameters", parameters},
          {"covariance", covariance},
          {"rms", fit.rms},
          {"max_error", fit.max_error},
          {"points", fit.points},
          {"aicc", json_or_null(fit.aicc)},
          {"abscissa", to_string(fit.abscissa)},
          {"weights", to_string(fit.weights)}};
}

Json json_or_null(const std::optional<Score>& score) {
  return score ? Json{{"rms", score->rms}, {"max_error", score->max_error}} : Json(nullptr);
}

// Returns the constants of all fits by name, null without fits.
Json json_from_constants(const std::vector<NamedFit>& fits) {
  Json json;
  for (const auto& [name, fit] : fits)
    for (const FitParameter& parameter : fit.parameters) json[name][parameter.name] = parameter.value;
  return json;
}

Json json_from_map(const MapErrors& map, const std::vector<std::string>& models) {
  Json json = {{"map", map.name}, {"mean_escape", json_or_null(map.mean_escape)}};
  json["models"] = Json::object();
  for (size_t m = 0; m < models.size(); ++m) {
    const ModelOnMap& model = map.models[m];
    json["models"][models[m]] = {{"parameters", json_from_constants(model.fits)},
                                 {"own", json_or_null(model.own)},
                                 {"shared", json_or_null(std::optional(model.shared))},
                                 {"held_out", json_or_null(model.held_out)}};
  }
  return json;
}

// Adds "maps" and, of several, "held_out" to the fits.
void add_comparison(const MapComparison& comparison, Json& json) {
  for (const MapErrors& map : comparison.maps) json["maps"].push_back(json_from_map(map, comparison.models));
  if (comparison.winner.empty()) return;
  json["held_out"] = {{"winner", comparison.winner}, {"rms", Json::object()}};
  for (size_t m = 0; m < comparison.models.size(); ++m)
    json["held_out"]["rms"][comparison.models[m]] = json_or_null(comparison.held_out_rms[m]);
}

// Returns `from_string` of a text; its error names the place.
template <class FromString>
auto with_place(const JsonReader& json, FromString from_string) {
  try {
    return from_string(json.text());
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", json.place(), error.what()));
  }
}

std::vector<double> covariance_from(const JsonReader& json, size_t count) {
  std::vector<double> covariance;
  const std::vector<JsonReader> rows = json.elements();
  if (rows.size() != count) json.refuse(fmt::format("a row for each of {} parameters", count));
  for (const JsonReader& row : rows) {
    const std::vector<JsonReader> values = row.elements();
    if (values.size() != count) row.refuse(fmt::format("a number for each of {} parameters", count));
    for (const JsonReader& value : values) covariance.push_back(value.number());
  }
  return covariance;
}

Fit fit_from_json(const JsonReader& json) {
  Fit fit;
  fit.model = json.at("model").text();
  fit.formula = json.at("formula").text();
  for (const auto& [name, parameter] : json.at("parameters").members()) {
    const std::optional<JsonReader> on_bound = parameter.find("on_bound");
    fit.parameters.push_back({name, parameter.at("value").number(), parameter.at("stderr").number_or_null(0),
                              on_bound && on_bound->flag()});
  }
  fit.covariance = covariance_from(json.at("covariance"), fit.parameters.size());
  fit.rms = json.at("rms").number(0);
  fit.max_error = json.at("max_error").number(0);
  fit.points = json.at("points").whole<int>();
  fit.aicc = json.at("aicc").number_or_null();
  fit.abscissa = with_place(json.at("abscissa"), abscissa_from_string);
  fit.weights = with_place(json.at("weights"), weights_from_string);
  return fit;
}

std::vector<MapEscape> escapes_from_json(const JsonReader& maps) {
  std::vector<MapEscape> escapes;
  for (const JsonReader& map : maps.elements()) {
    MapEscape& escape = escapes.emplace_back(MapEscape{map.at("map").text(), std::nullopt});
    const JsonReader mean = map.at("mean_escape");
    if (!mean.is_null()) escape.mean_escape = mean.number(0, 1);
  }
  return escapes;
}

}  // namespace

Json json_from_fits(const FitFile& file) {
  Json json = Json::object();
  for (const auto& [name, fit] : file.fits) json[name] = json_from_fit(fit);
  add_comparison(file.comparison, json);
  json["provenance"] = file.provenance;
  return json;
}

FitFile fits_from_json(const Json& json, const std::filesystem::path& path) {
  FitFile file;
  for (const auto& [name, value] : JsonReader(json, path.string()).members()) {
    if (name == "provenance") {
      check_read_provenance(value);
      file.provenance = json["provenance"];
    } else if (name == "maps") {
      file.escapes = escapes_from_json(value);
    } else if (name != "held_out") {
      file.fits.push_back({name, fit_from_json(value)});
    }
  }
  return file;
}

std::vector<std::string> model_origin(const FitFile& file, ModelKind kind) {
  std::vector<std::string> lines = describe_fits(file.fits, kind);
  lines.insert(lines.begin(),
               std::string("Ambient occlusion with all bounces of light, by hemibake ") + kVersion + ".");
  // Text travels further than the result folder: no folders, command lines or hashes of the maker.
  if (file.provenance.contains("input") && file.provenance["input"].is_string())
    lines.push_back(fmt::format(
        "input: {}", std::filesystem::path(file.provenance["input"].get<std::string>()).filename().string()));
  for (std::string& line : lines) line = printable_line(line);
  return lines;
}

FitFile read_fits(const std::filesystem::path& path) { return fits_from_json(read_json(path), path); }

void write_fits(const std::filesystem::path& path, const FitFile& file) {
  write_json(path, json_from_fits(file));
}

}  // namespace hemibake
