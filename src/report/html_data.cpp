#include "report/html_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/statistics.h"
#include "core/version.h"
#include "fitting/fitted_model.h"
#include "io/provenance.h"
#include "lighting/texel_model.h"
#include "textures/light.h"
#include "transport/series.h"

namespace hemibake {
namespace {

// Albedos of the table of errors over the texels.
constexpr std::array kErrorAlbedos = {0.2, 0.5, 0.8, 0.9, 0.95};

// Names a way of shading that needs nothing of this map.
struct OtherShading {
  const char* id;
  const char* title;
  Prediction predict;
};

const std::vector<OtherShading>& other_shadings() {
  static const std::vector<OtherShading> all = {
      {"off", "α alone (uniform AO)", [](double ao, double, double) { return ao; }},
      {"off-visibility", "V alone (cosine-weighted AO)",
       [](double, double visibility, double) { return visibility; }},
      {"jimenez", "V: cubic of Jimenez 2016",
       [](double, double visibility, double albedo) { return JimenezModel().total(visibility, albedo); }}};
  return all;
}

// Adds the squared errors at one texel.
void add_squares(const TexelInputs& inputs, double truth, std::span<const ReportModel> models,
                 TexelErrors& sums) {
  const auto square = [&](double light) { return (light - truth) * (light - truth); };
  for (size_t m = 0; m < models.size(); ++m)
    sums.models[m] += square(model_irradiance(models[m].model, inputs, sums.albedo));
  for (size_t k = 0; k < other_shadings().size(); ++k)
    sums.others[k] += square(other_shadings()[k].predict(inputs.ao, inputs.visibility, sums.albedo));
}

// The truth counts the bounces after the last stored one as a geometric series.
std::vector<TexelErrors> texel_errors(const Bake& bake, std::span<const ReportModel> models) {
  std::vector<TexelErrors> errors;
  for (const double albedo : kErrorAlbedos)
    errors.push_back(
        {albedo, std::vector<double>(models.size()), std::vector<double>(other_shadings().size())});
  const size_t count = bake.visible_fraction.size();
  size_t texels = 0;
  for (size_t i = 0; i < count; ++i) {
    if (is_hole(bake, i)) continue;
    ++texels;
    const TexelInputs inputs = texel_inputs(bake, i);
    for (TexelErrors& sums : errors) add_squares(inputs, irradiance_at(bake, i, sums.albedo), models, sums);
  }
  for (TexelErrors& sums : errors)
    for (std::vector<double>* list : {&sums.models, &sums.others})
      for (double& square : *list) square = std::sqrt(square / static_cast<double>(texels));
  return errors;
}

BakeMeans means_of(const Bake& bake) {
  BakeMeans means;
  if (!bake.visible_fraction.empty()) means.ao = mean(bake.visible_fraction.values);
  if (has_visibility(bake)) {
    Moments visibility;
    const size_t count = static_cast<size_t>(bake.width) * static_cast<size_t>(bake.height);
    for (size_t i = 0; i < count; ++i)
      if (!is_hole(bake, i)) visibility.add(visibility_at(bake, i));
    means.visibility = visibility.mean;
  }
  for (const Grid<float>& plane : bake.irradiance) means.irradiance.push_back(mean(plane.values) / kPi);
  if (!bake.total.empty()) means.total = mean(bake.total.values) / kPi;
  if (!bake.residual.empty()) {
    means.residual = mean(bake.residual.values);
    means.worst_residual = -HUGE_VAL;
    for (const float residual : bake.residual.values)
      means.worst_residual = std::fmax(*means.worst_residual, static_cast<double>(residual));
  }
  return means;
}

BinTotals totals_of(const CurveBin& bin) {
  BinTotals totals;
  if (bin.count == 0) return totals;
  for (size_t r = 0; r < kPlotAlbedos.size(); ++r)
    totals.all_bounces[r] = total_over_pi(bin, kPlotAlbedos[r]);
  totals.stored_bounces = sum_bounces(
      bin.bounces.size(), [&](size_t b) { return bin.bounces[b].mean / kPi; }, 1);
  return totals;
}

// Returns E/π of a model over the bins of curves, which hold α and V; none where that does not suffice.
std::optional<Prediction> prediction_of(const AnyModel& model) {
  if (std::holds_alternative<BounceMapModel>(model)) return std::nullopt;
  return [&model](double ao, double visibility, double albedo) {
    return model_irradiance(model, {ao, visibility}, albedo);
  };
}

std::string title_of(const ReportFolder& folder) {
  const auto input_of = [](const auto& file) {
    return file && file->provenance.is_object() ? file->provenance.value("input", "") : std::string();
  };
  if (const std::string input = input_of(folder.bake); !input.empty()) return input;
  if (const std::string input = input_of(folder.fits); !input.empty()) return input;
  return valid_utf8(folder.path.lexically_normal().string());
}

}  // namespace

std::vector<ReportModel> report_models(const std::optional<FitFile>& fits, const Bake* bake) {
  const auto origin = [](const char* line) {
    return std::vector<std::string>{
        std::string("Ambient occlusion with all bounces of light, by hemibake ") + kVersion + ".", line};
  };
  std::vector<ReportModel> models;
  const auto add_of_visibility = [&](const char* id, const std::string& title, const AnyModel& model) {
    if (!bake || missing_plane(model, *bake).empty())
      models.push_back({id, title, model, origin("Without constants fitted to a map.")});
  };
  add_of_visibility("visibility-ao", "V and α, no constants (g = α)", VisibilityAoModel{});
  add_of_visibility("visibility", "V, no constants (g = V)", VisibilityModel{});
  if (bake && !bake->bounce.empty())
    add_of_visibility("bounce-map", fmt::format("bounce map: V and E at ρ = {:.4g}", bake->bounce_albedo),
                      BounceMapModel{bake->bounce_albedo});
  const auto add_fitted = [&](const char* id, const char* title, ModelKind kind) {
    if (fits && has_model(fits->fits, kind))
      models.push_back({id, title, any_fitted_model(fits->fits, kind), model_origin(*fits, kind)});
  };
  add_fitted("bounded", "α: bounded model, fitted", ModelKind::kBounded);
  add_fitted("published", "α: formulas of 2018, fitted", ModelKind::kMayaux2018);
  models.push_back({"notes", "α: formulas and constants of 2018", GuardedModel{},
                    origin("Formulas and constants: B. Mayaux, Improved Ambient Occlusion, 2018.")});
  return models;
}

ReportData gather_report(const ReportFolder& folder, std::span<const ReportModel> models, const Rgb& albedo) {
  ReportData data{title_of(folder), albedo, {}, {}, {}, {}, {}, {}};
  if (folder.bake) {
    const Bake& bake = folder.bake->bake;
    data.means = means_of(bake);
    data.bounce_map = bounce_map_loss(bake);
    if (!bake.visible_fraction.empty() && bake.irradiance.size() > 1)
      data.texel_errors = texel_errors(bake, models);
  }
  const auto score = [&](const std::optional<Prediction>& predict) -> std::optional<Score> {
    if (!folder.curves || !predict) return std::nullopt;
    return score_prediction(*predict, *folder.curves);
  };
  for (const ReportModel& model : models) data.scores.push_back(score(prediction_of(model.model)));
  for (const OtherShading& other : other_shadings())
    data.other_models.push_back({other.id, other.title, score(other.predict)});
  if (folder.curves)
    for (const CurveBin& bin : folder.curves->bins) data.totals.push_back(totals_of(bin));
  return data;
}

std::vector<ReportProbe> report_probes(const Bake& bake, std::span<const ReportModel> models, int stride,
                                       const Rgb& albedo) {
  constexpr int kProbesPerSide = 4;
  std::vector<ReportProbe> probes;
  if (bake.visible_fraction.empty()) return probes;
  const int width = (bake.width + stride - 1) / stride, height = (bake.height + stride - 1) / stride;
  const int columns = std::min(kProbesPerSide, width), rows = std::min(kProbesPerSide, height);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      ReportProbe& probe = probes.emplace_back();
      probe.x = (2 * i + 1) * width / (2 * columns) * stride;
      probe.y = (2 * j + 1) * height / (2 * rows) * stride;
      const size_t texel = bake.visible_fraction.index(probe.x, probe.y);
      const TexelInputs inputs = texel_inputs(bake, texel);
      probe.ao = bake.visible_fraction[texel];
      probe.visibility = inputs.visibility;
      if (!bake.bounce.empty()) probe.bounce = inputs.bounce;
      for (const Grid<float>& plane : bake.irradiance) probe.irradiance.push_back(plane[texel] / kPi);
      probe.models.resize(models.size());
      for (size_t c = 0; c < albedo.size(); ++c) {
        for (size_t m = 0; m < models.size(); ++m)
          probe.models[m][c] = model_irradiance(models[m].model, inputs, albedo[c]);
        probe.truth[c] = sum_bounces(bake.irradiance, texel, albedo[c]) / kPi;
      }
    }
  return probes;
}

}  // namespace hemibake
