#include "io/fit_file.h"

#include <fmt/format.h>

#include <cmath>

#include "core/error.h"
#include "core/version.h"
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

std::optional<double> number_or_null(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

// Throws Json::exception for what is missing or of another type.
Fit fit_from_json(const Json& json) {
  Fit fit;
  fit.model = json.at("model").get<std::string>();
  fit.formula = json.at("formula").get<std::string>();
  for (const auto& [name, parameter] : json.at("parameters").items()) {
    fit.parameters.push_back({name, parameter.at("value").get<double>(),
                              number_or_null(parameter.at("stderr")), parameter.value("on_bound", false)});
  }
  for (const Json& row : json.at("covariance")) {
    for (const Json& value : row) fit.covariance.push_back(value.get<double>());
  }
  fit.rms = json.at("rms").get<double>();
  fit.max_error = json.at("max_error").get<double>();
  fit.points = json.at("points").get<int>();
  fit.aicc = number_or_null(json.at("aicc"));
  fit.abscissa = abscissa_from_string(json.at("abscissa").get<std::string>());
  fit.weights = weights_from_string(json.at("weights").get<std::string>());
  return fit;
}

// Throws Json::exception for what is missing or of another type, InputError for shares outside 0..1.
std::vector<MapEscape> escapes_from_json(const Json& maps) {
  std::vector<MapEscape> escapes;
  for (const Json& map : maps) {
    const MapEscape escape{map.at("map").get<std::string>(), number_or_null(map.at("mean_escape"))};
    if (escape.mean_escape && !(*escape.mean_escape >= 0 && *escape.mean_escape <= 1))
      throw InputError(
          fmt::format("mean_escape of {} is {}, expected 0 to 1", escape.map, *escape.mean_escape));
    escapes.push_back(escape);
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
  if (!json.is_object()) throw InputError(fmt::format("{}: not a JSON object, expected fits", path.string()));
  FitFile file;
  for (const auto& [name, value] : json.items()) {
    if (name == "provenance") file.provenance = value;
    if (name == "provenance" || name == "held_out") continue;
    try {
      if (name == "maps")
        file.escapes = escapes_from_json(value);
      else
        file.fits.push_back({name, fit_from_json(value)});
    } catch (const Json::exception& error) {
      const std::string_view what = error.what();  // "[json.exception.…] reason"
      throw InputError(fmt::format("{}: {}: {}, expected a fit as 'hemibake fit' writes it", path.string(),
                                   name, what.substr(what.find("] ") + 2)));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}: {}", path.string(), name, error.what()));
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
  return lines;
}

FitFile read_fits(const std::filesystem::path& path) { return fits_from_json(read_json(path), path); }

void write_fits(OutputFile& output, const FitFile& file) { write_json(output, json_from_fits(file)); }

void write_fits(const std::filesystem::path& path, const FitFile& file) {
  write_json(path, json_from_fits(file));
}

}  // namespace hemibake
