#include "report/html_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/statistics.h"
#include "fitting/candidates.h"
#include "fitting/fitted_model.h"
#include "model/shader_text.h"

namespace hemibake {
namespace {

using Json = nlohmann::ordered_json;

// Enough for a plot, and half the size of what reads back exactly.
Json rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::stod(fmt::format("{:.6g}", value));
}

// curves: how many of the bounces.
Json json_from_curves(const Curves& curves, int bounces) {
  Json bins = Json::array();
  for (const CurveBin& bin : curves.bins) {
    Json entry = {{"low", rounded(bin.ao_low)}, {"high", rounded(bin.ao_high)}, {"count", bin.count}};
    if (bin.count > 0) {
      Json mean = Json::array(), spread = Json::array();
      for (int b = 0; b < bounces; ++b) {
        mean.push_back(rounded(bin.bounces[b].mean / kPi));
        spread.push_back(rounded(bin.bounces[b].stddev / kPi));
      }
      entry["mean"] = mean;
      entry["spread"] = spread;
    }
    bins.push_back(entry);
  }
  return {{"bounces", bounces}, {"has_counts", curves.has_counts}, {"bins", bins}};
}

double truth_over_pi(const Bake& bake, size_t texel, double albedo) {
  double sum = 0;
  for (size_t b = bake.irradiance.size(); b-- > 0;) sum = sum * albedo + bake.irradiance[b][texel];
  return sum / kPi;
}

// Over all texels at one albedo.
Json texel_errors(const Bake& bake, std::span<const ReportModel> models, double albedo) {
  const size_t count = bake.visible_fraction.size();
  std::vector<double> squares(models.size() + 1);
  for (size_t i = 0; i < count; ++i) {
    const double ao = bake.visible_fraction[i], truth = truth_over_pi(bake, i, albedo);
    for (size_t m = 0; m <= models.size(); ++m) {
      const double difference = (m < models.size() ? models[m].total(ao, albedo) : ao) - truth;
      squares[m] += difference * difference;
    }
  }
  Json rms = {{"albedo", albedo}};
  for (size_t m = 0; m <= models.size(); ++m)
    rms[m < models.size() ? models[m].id : "off"] =
        rounded(std::sqrt(squares[m] / static_cast<double>(count)));
  return rms;
}

Json json_from_bake(const BakeFile& file, std::span<const ReportModel> models, const PackedPlanes& planes) {
  const Bake& bake = file.bake;
  Json json = {{"width", bake.width}, {"height", bake.height}};
  json["mean_ao"] = bake.visible_fraction.empty() ? Json() : rounded(mean(bake.visible_fraction.values));
  json["mean_irradiance"] = Json::array();
  for (const Grid<float>& plane : bake.irradiance)
    json["mean_irradiance"].push_back(rounded(mean(plane.values) / kPi));
  json["mean_total"] = bake.total.empty() ? Json() : rounded(mean(bake.total.values) / kPi);
  json["mean_residual"] = bake.residual.empty() ? Json() : rounded(mean(bake.residual.values));
  json["worst_residual"] =
      bake.residual.empty()
          ? Json()
          : rounded(*std::max_element(bake.residual.values.begin(), bake.residual.values.end()));
  json["texel_errors"] = Json::array();
  if (!bake.visible_fraction.empty() && !bake.irradiance.empty())
    for (const double albedo : {0.2, 0.5, 0.8})
      json["texel_errors"].push_back(texel_errors(bake, models, albedo));
  Json list = Json::array();
  for (const PackedPlane& plane : planes.planes) list.push_back({{"name", plane.name}, {"step", plane.step}});
  json["planes"] = {{"width", planes.width},
                    {"height", planes.height},
                    {"stride", planes.stride},
                    {"list", list},
                    {"ao_error", planes.ao_error},
                    {"irradiance_error_over_pi", planes.irradiance_error_over_pi},
                    {"total_error_over_pi", planes.total_error_over_pi}};
  json["settings"] = file.provenance;
  return json;
}

template <class Model>
Json shader_texts(const Model& model, const std::vector<std::string>& origin) {
  return {{"glsl", shader_text(model, Language::kGlsl, origin)},
          {"hlsl", shader_text(model, Language::kHlsl, origin)},
          {"cpp", shader_text(model, Language::kCpp, origin)}};
}

Json json_from_score(const Prediction& prediction, const Curves& curves) {
  const Score score = score_prediction(prediction, curves);
  return {{"rms", rounded(score.rms)}, {"max", rounded(score.max_error)}};
}

Json json_from_model(const ReportModel& model, const std::optional<Curves>& curves) {
  Json json = {{"id", model.id}, {"title", model.title}};
  if (model.id == "bounded") {
    const BoundedModel& m = model.bounded;
    json["constants"] = {{"k0", m.k0}, {"k1", m.k1}, {"q", m.q}, {"d", m.d}};
    json["shader"] = shader_texts(m, model.origin);
  } else {
    const Mayaux2018Model& m = model.guarded.published;
    json["constants"] = {{"k", m.k}, {"e", m.e}, {"A", m.a}, {"B", m.b}};
    json["shader"] = shader_texts(model.guarded, model.origin);
  }
  json["score"] = nullptr;
  if (curves)
    json["score"] =
        json_from_score([&](double ao, double, double albedo) { return model.total(ao, albedo); }, *curves);
  return json;
}

// Models without constants of this map, for comparison.
Json other_scores(const Curves& curves) {
  const JimenezModel jimenez;
  return Json::array(
      {{{"title", "plain AO"},
        {"score", json_from_score([](double ao, double, double) { return ao; }, curves)}},
       {{"title", "Jimenez 2016, of E₀/π"},
        {"score", json_from_score([&](double, double visibility,
                                      double albedo) { return jimenez.total(visibility, albedo); },
                                  curves)}}});
}

std::string title_of(const ReportFolder& folder) {
  if (folder.bake && folder.bake->provenance.is_object() && folder.bake->provenance.contains("input"))
    return folder.bake->provenance["input"].get<std::string>();
  if (folder.fits && folder.fits->provenance.is_object() && folder.fits->provenance.contains("input"))
    return folder.fits->provenance["input"].get<std::string>();
  return valid_utf8(folder.path.lexically_normal().string());
}

}  // namespace

std::vector<ReportModel> report_models(const ReportFolder& folder) {
  std::vector<ReportModel> models;
  if (folder.fits) {
    const std::filesystem::path path = folder.path / "fit.json";
    const FitFile& fits = *folder.fits;
    if (has_fit(fits, "bounded_F0") && has_fit(fits, "bounded_tau"))
      models.push_back({"bounded",
                        "bounded model, fitted",
                        bounded_model(fits, path),
                        {},
                        bounded_model_origin(fits, path)});
    if (has_fit(fits, "F0") && has_fit(fits, "F1"))
      models.push_back({"published",
                        "formulas of 2018, fitted",
                        {},
                        guarded_model(fits, path),
                        guarded_model_origin(fits, path)});
  }
  models.push_back({"notes",
                    "formulas and constants of 2018",
                    {},
                    {},
                    {"Ambient occlusion with all bounces of light, by hemibake " HEMIBAKE_VERSION ".",
                     "Formulas and constants: B. Mayaux, Improved Ambient Occlusion, 2018."}});
  return models;
}

nlohmann::ordered_json report_data(const ReportFolder& folder, std::span<const ReportModel> models,
                                   const PackedPlanes& planes, const Rgb& albedo) {
  Json json = {{"version", HEMIBAKE_VERSION}, {"title", title_of(folder)}, {"albedo", albedo}};
  json["bake"] = folder.bake ? json_from_bake(*folder.bake, models, planes) : Json();
  json["curves"] = folder.curves ? json_from_curves(*folder.curves, folder.curves->bounce_count) : Json();
  json["fits"] = folder.fits ? json_from_fits(*folder.fits) : Json();
  json["models"] = Json::array();
  for (const ReportModel& model : models) json["models"].push_back(json_from_model(model, folder.curves));
  json["other_models"] = folder.curves ? other_scores(*folder.curves) : Json::array();
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
         {"curves", json_from_curves(step.curves, std::min(step.curves.bounce_count, 2))}});
  return json;
}

nlohmann::ordered_json report_probes(const Bake& bake, std::span<const ReportModel> models, int stride,
                                     const Rgb& albedo) {
  constexpr int kProbesPerSide = 4;
  Json probes = Json::array();
  if (bake.visible_fraction.empty()) return probes;
  const int width = (bake.width + stride - 1) / stride, height = (bake.height + stride - 1) / stride;
  for (int j = 0; j < std::min(kProbesPerSide, height); ++j)
    for (int i = 0; i < std::min(kProbesPerSide, width); ++i) {
      const int x = (2 * i + 1) * width / (2 * std::min(kProbesPerSide, width)) * stride;
      const int y = (2 * j + 1) * height / (2 * std::min(kProbesPerSide, height)) * stride;
      const size_t texel = bake.visible_fraction.index(x, y);
      const double ao = bake.visible_fraction[texel];
      Json probe = {{"x", x}, {"y", y}, {"ao", ao}, {"irradiance", Json::array()}};
      for (const Grid<float>& plane : bake.irradiance) probe["irradiance"].push_back(plane[texel] / kPi);
      for (const ReportModel& model : models)
        for (const double rho : albedo) probe["models"][model.id].push_back(model.total(ao, rho));
      for (const double rho : albedo) probe["truth"].push_back(truth_over_pi(bake, texel, rho));
      probes.push_back(probe);
    }
  return probes;
}

}  // namespace hemibake
