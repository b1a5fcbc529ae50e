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
    parameters[parameter.name] = {{"value", parameter.value},
                                  {"stderr", json_or_null(parameter.standard_error)}};
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

std::optional<double> number_or_null(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

// Throws Json::exception for what is missing or of another type.
Fit fit_from_json(const Json& json) {
  Fit fit;
  fit.model = json.at("model").get<std::string>();
  fit.formula = json.at("formula").get<std::string>();
  for (const auto& [name, parameter] : json.at("parameters").items()) {
    fit.parameters.push_back(
        {name, parameter.at("value").get<double>(), number_or_null(parameter.at("stderr"))});
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

}  // namespace

Json json_from_fits(const FitFile& file) {
  Json json = Json::object();
  for (const auto& [name, fit] : file.fits) json[name] = json_from_fit(fit);
  json["provenance"] = file.provenance;
  return json;
}

FitFile fits_from_json(const Json& json, const std::filesystem::path& path) {
  if (!json.is_object()) throw InputError(fmt::format("{}: not a JSON object, expected fits", path.string()));
  FitFile file;
  for (const auto& [name, value] : json.items()) {
    if (name == "provenance") {
      file.provenance = value;
      continue;
    }
    try {
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

void write_fits(const std::filesystem::path& path, const FitFile& file) {
  write_json(path, json_from_fits(file));
}

}  // namespace hemibake
