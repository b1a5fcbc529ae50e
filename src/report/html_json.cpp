#include "report/html_json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/constants.h"
#include "core/version.h"
#include "model/shader_text.h"

namespace hemibake {
namespace {

using Json = nlohmann::ordered_json;

// Enough digits for a plot, and half the size of a number that reads back exactly.
Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::stod(fmt::format("{:.6g}", value));
}

Json rounded(const std::optional<double>& value) { return value ? rounded(*value) : Json(); }

template <class Values>
Json rounded_list(const Values& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(rounded(value));
  return list;
}

// bounces: number of those written. totals: none, or of each bin.
Json json_from_curves(const Curves& curves, int bounces, std::span<const BinTotals> totals) {
  Json bins = Json::array();
  for (size_t j = 0; j < curves.bins.size(); ++j) {
    const CurveBin& bin = curves.bins[j];
    Json& entry =
        bins.emplace_back(Json{{"low", rounded(bin.low)}, {"high", rounded(bin.high)}, {"count", bin.count}});
    if (bin.count == 0) continue;
    entry["mean"] = entry["spread"] = Json::array();
    for (int b = 0; b < bounces; ++b) {
      entry["mean"].push_back(rounded(bin.bounces[b].mean / kPi));
      entry["spread"].push_back(rounded(bin.bounces[b].stddev / kPi));
    }
    if (totals.empty()) continue;
    entry["all_bounces"] = rounded_list(totals[j].all_bounces);
    entry["stored_bounces"] = rounded(totals[j].stored_bounces);
  }
  return {{"bounces", bounces}, {"has_counts", curves.has_counts}, {"bins", bins}};
}

Json json_from_texel_errors(const TexelErrors& errors, std::span<const ReportModel> models,
                            std::span<const OtherModel> others) {
  Json json = {{"albedo", errors.albedo}};
  for (size_t m = 0; m < models.size(); ++m) json[models[m].id] = rounded(errors.models[m]);
  for (size_t k = 0; k < others.size(); ++k) json[others[k].id] = rounded(errors.others[k]);
  return json;
}

// rms, percentile, largest: one for each albedo.
Json json_from_bounce_map(const std::optional<BounceMapLoss>& loss) {
  if (!loss) return nullptr;
  Json list = Json::array();
  for (const StoredLoss& stored : loss->stored) {
    Json& json = list.emplace_back(Json{{"bits", stored.bits}, {"box", stored.box}});
    for (const MapError& error : stored.by_albedo) {
      json["rms"].push_back(rounded(error.rms));
      json["percentile"].push_back(rounded(error.percentile));
      json["largest"].push_back(rounded(error.largest));
    }
  }
  return {{"bounce_albedo", loss->bounce_albedo},
          {"truth_rms", rounded(loss->truth_rms)},
          {"albedos", kBounceMapAlbedos},
          {"stored", list}};
}

Json json_from_bake(const BakeFile& file, std::span<const ReportModel> models, const PackedPlanes& planes,
                    const ReportData& data) {
  Json json = {{"width", file.bake.width}, {"height", file.bake.height}};
  json["mean_ao"] = rounded(data.means.ao);
  json["mean_visibility"] = rounded(data.means.visibility);
  json["mean_irradiance"] = rounded_list(data.means.irradiance);
  json["mean_total"] = rounded(data.means.total);
  json["mean_residual"] = rounded(data.means.residual);
  json["worst_residual"] = rounded(data.means.worst_residual);
  json["texel_errors"] = Json::array();
  for (const TexelErrors& errors : data.texel_errors)
    json["texel_errors"].push_back(json_from_texel_errors(errors, models, data.other_models));
  json["bounce_map"] = json_from_bounce_map(data.bounce_map);
  Json list = Json::array();
  for (const PackedPlane& plane : planes.planes) list.push_back({{"name", plane.name}, {"step", plane.step}});
  json["planes"] = {{"width", planes.width},
                    {"height", planes.height},
                    {"stride", planes.stride},
                    {"list", list},
                    {"ao_error", planes.ao_error},
                    {"bounce_error", planes.bounce_error},
                    {"irradiance_error_over_pi", planes.irradiance_error_over_pi},
                    {"total_error_over_pi", planes.total_error_over_pi}};
  json["settings"] = file.provenance;
  return json;
}

Json json_from_score(const std::optional<Score>& score) {
  if (!score) return nullptr;
  return {{"rms", rounded(score->rms)}, {"max", rounded(score->max_error)}};
}

Json constants_of(const BoundedModel& m) { return {{"k0", m.k0}, {"k1", m.k1}, {"q", m.q}, {"d", m.d}}; }
Json constants_of(const GuardedModel& m) {
  return {{"k", m.formulas.k}, {"e", m.formulas.e}, {"A", m.formulas.a}, {"B", m.formulas.b}};
}
Json constants_of(const VisibilityModel& m) { return {{"dark", m.dark}, {"open", m.open}}; }
Json constants_of(const VisibilityAoModel& m) { return {{"dark", m.dark}, {"open", m.open}}; }
Json constants_of(const VisibilityNormalModel&) { return Json::object(); }
Json constants_of(const MeanEscapeModel& m) { return {{"mean_escape", m.mean_escape}}; }
Json constants_of(const BounceMapModel& m) { return {{"bounce_albedo", m.bounce_albedo}}; }
Json constants_of(const JimenezModel& m) { return {{"parameters", m.parameters}}; }

Json json_from_model(const ReportModel& model, const std::optional<Score>& score) {
  const auto text = [&](Language language) { return shader_text(model.model, language, model.origin); };
  return {{"id", model.id},
          {"title", model.title},
          {"constants", std::visit([](const auto& m) { return constants_of(m); }, model.model)},
          {"shader",
           {{"glsl", text(Language::kGlsl)}, {"hlsl", text(Language::kHlsl)}, {"cpp", text(Language::kCpp)}}},
          {"score", json_from_score(score)}};
}

}  // namespace

Json json_from_report(const ReportFolder& folder, std::span<const ReportModel> models,
                      const PackedPlanes& planes, const ReportData& data) {
  Json json = {{"version", kVersion}, {"title", data.title}, {"albedo", data.albedo}};
  json["plot_albedos"] = kPlotAlbedos;
  json["bake"] = folder.bake ? json_from_bake(*folder.bake, models, planes, data) : Json();
  json["curves"] =
      folder.curves ? json_from_curves(*folder.curves, folder.curves->bounce_count, data.totals) : Json();
  json["fits"] = folder.fits ? json_from_fits(*folder.fits) : Json();
  json["models"] = Json::array();
  for (size_t m = 0; m < models.size(); ++m)
    json["models"].push_back(json_from_model(models[m], data.scores[m]));
  json["other_models"] = Json::array();
  for (const OtherModel& other : data.other_models)
    json["other_models"].push_back(
        {{"id", other.id}, {"title", other.title}, {"score", json_from_score(other.score)}});
  json["check"] = folder.check;
  json["run"] = folder.run;
  json["trade"] = folder.trade;
  json["pictures"] = Json::array();
  for (const ReportPicture& picture : folder.pictures)
    json["pictures"].push_back({{"name", picture.name}, {"here", !picture.png.empty()}});
  json["sweep"] = Json::array();
  for (const SweepCurves& step : folder.sweep)
    json["sweep"].push_back(
        {{"amplitude_m", step.amplitude_m},
         {"curves", json_from_curves(step.curves, std::min(step.curves.bounce_count, 2), {})}});
  return json;
}

Json json_from_probes(std::span<const ReportProbe> probes, std::span<const ReportModel> models) {
  Json list = Json::array();
  for (const ReportProbe& probe : probes) {
    Json& json = list.emplace_back(
        Json{{"x", probe.x}, {"y", probe.y}, {"ao", probe.ao}, {"visibility", probe.visibility}});
    if (probe.bounce) json["bounce"] = *probe.bounce;
    json["irradiance"] = probe.irradiance;
    for (size_t m = 0; m < models.size(); ++m) json["models"][models[m].id] = probe.models[m];
    json["truth"] = probe.truth;
  }
  return list;
}

Json json_from_totals(const Curves& curves, std::span<const BinTotals> totals) {
  Json list = Json::array();
  for (size_t j = 0; j < totals.size(); ++j)
    if (curves.bins[j].count > 0)
      list.push_back({{"ao", bin_center(curves.bins[j])},
                      {"all_bounces", totals[j].all_bounces},
                      {"stored_bounces", totals[j].stored_bounces}});
  return list;
}

}  // namespace hemibake
