#include "report/html_data.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/statistics.h"
#include "core/version.h"
#include "fitting/fitted_model.h"
#include "io/provenance.h"
#include "transport/series.h"

namespace hemibake {
namespace {

// Albedos of the table of errors over the texels.
constexpr std::array kErrorAlbedos = {0.2, 0.5, 0.8};

double truth_over_pi(const Bake& bake, size_t texel, double albedo) {
  return sum_bounces(bake.irradiance, texel, albedo) / kPi;
}

TexelErrors texel_errors(const Bake& bake, std::span<const ReportModel> models, double albedo) {
  const size_t count = bake.visible_fraction.size();
  std::vector<double> squares(models.size() + 1);
  for (size_t i = 0; i < count; ++i) {
    const double ao = bake.visible_fraction[i], truth = truth_over_pi(bake, i, albedo);
    for (size_t m = 0; m <= models.size(); ++m) {
      const double difference = (m < models.size() ? models[m].total(ao, albedo) : ao) - truth;
      squares[m] += difference * difference;
    }
  }
  for (double& square : squares) square = std::sqrt(square / static_cast<double>(count));
  return {albedo, squares};
}

BakeMeans means_of(const Bake& bake) {
  BakeMeans means;
  if (!bake.visible_fraction.empty()) means.ao = mean(bake.visible_fraction.values);
  for (const Grid<float>& plane : bake.irradiance) means.irradiance.push_back(mean(plane.values) / kPi);
  if (!bake.total.empty()) means.total = mean(bake.total.values) / kPi;
  if (!bake.residual.empty()) {
    means.residual = mean(bake.residual.values);
    means.worst_residual = *std::ranges::max_element(bake.residual.values);
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

std::vector<OtherModel> other_models(const Curves& curves) {
  const Prediction plain = [](double ao, double, double) { return ao; };
  const Prediction jimenez = [](double, double visibility, double albedo) {
    return JimenezModel().total(visibility, albedo);
  };
  return {{"plain AO", score_prediction(plain, curves)},
          {"Jimenez 2016, of E₀/π", score_prediction(jimenez, curves)}};
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

std::vector<ReportModel> report_models(const std::optional<FitFile>& fits) {
  std::vector<ReportModel> models;
  const auto add = [&](const char* id, const char* title, ModelKind kind) {
    if (fits && has_model(fits->fits, kind))
      models.push_back({id, title, fitted_model(fits->fits, kind), model_origin(*fits, kind)});
  };
  add("bounded", "bounded model, fitted", ModelKind::kBounded);
  add("published", "formulas of 2018, fitted", ModelKind::kMayaux2018);
  models.push_back(
      {"notes",
       "formulas and constants of 2018",
       GuardedModel{},
       {std::string("Ambient occlusion with all bounces of light, by hemibake ") + kVersion + ".",
        "Formulas and constants: B. Mayaux, Improved Ambient Occlusion, 2018."}});
  return models;
}

ReportData gather_report(const ReportFolder& folder, std::span<const ReportModel> models, const Rgb& albedo) {
  ReportData data{title_of(folder), albedo, {}, {}, {}, {}, {}};
  if (folder.bake) {
    const Bake& bake = folder.bake->bake;
    data.means = means_of(bake);
    if (!bake.visible_fraction.empty() && !bake.irradiance.empty())
      for (const double rho : kErrorAlbedos) data.texel_errors.push_back(texel_errors(bake, models, rho));
  }
  if (!folder.curves) return data;
  for (const CurveBin& bin : folder.curves->bins) data.totals.push_back(totals_of(bin));
  for (const ReportModel& model : models) {
    const Prediction total = [&](double ao, double, double rho) { return model.total(ao, rho); };
    data.scores.push_back(score_prediction(total, *folder.curves));
  }
  data.other_models = other_models(*folder.curves);
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
      probe.ao = bake.visible_fraction[texel];
      for (const Grid<float>& plane : bake.irradiance) probe.irradiance.push_back(plane[texel] / kPi);
      probe.models.resize(models.size());
      for (size_t c = 0; c < albedo.size(); ++c) {
        for (size_t m = 0; m < models.size(); ++m) probe.models[m][c] = models[m].total(probe.ao, albedo[c]);
        probe.truth[c] = truth_over_pi(bake, texel, albedo[c]);
      }
    }
  return probes;
}

}  // namespace hemibake
