// Gathers what a report says, as structs; html_json.h writes them for the page.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fitting/candidates.h"
#include "model/model.h"
#include "report/html_folder.h"
#include "textures/bounce_map_loss.h"

namespace hemibake {

using Rgb = std::array<double, 3>;

// Albedos that the page plots all bounces at.
inline constexpr std::array<double, 11> kPlotAlbedos = {0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1};

// Offers a model on the page.
struct ReportModel {
  std::string id;     // bounce-map, visibility-ao, visibility, bounded, published or notes
  std::string title;  // begins with what the model takes: α, V or the bounce map
  AnyModel model;
  std::vector<std::string> origin;  // head of its shader texts
};

// Returns the models of V without constants and the bounce map, as far as the bake holds what they take,
// those of α that were fitted to the folder's curves, and that of 2018 with its published constants. Throws
// InputError where constants of `fits` cannot be used, without the file's name.
// bake: null where the folder has none; the bounce map is then left out.
std::vector<ReportModel> report_models(const std::optional<FitFile>& fits, const Bake* bake);

// Holds the light at one albedo against every model, and then every other way of shading: rms over all texels
// of E/π.
struct TexelErrors {
  double albedo = 0;
  std::vector<double> models, others;
};

// Holds means over the texels of a bake; irradiance over π.
struct BakeMeans {
  std::optional<double> ao, visibility, total, residual, worst_residual;
  std::vector<double> irradiance;
};

// Holds E/π of one bin at each of kPlotAlbedos, the tail after the last bounce included, and at albedo 1
// without.
struct BinTotals {
  std::array<double, kPlotAlbedos.size()> all_bounces{};
  double stored_bounces = 0;
};

// Holds the errors that a way of shading has over the bins of the curves.
struct OtherModel {
  std::string id;  // off (α alone), off-visibility (V alone) or jimenez
  std::string title;
  std::optional<Score> score;  // none without curves
};

// Holds what a report computes from a folder; empty where the folder lacks the data.
struct ReportData {
  std::string title;
  Rgb albedo{};  // the page opens with
  BakeMeans means;
  std::vector<TexelErrors> texel_errors;
  std::optional<BounceMapLoss> bounce_map;   // none where the bake lacks what it takes
  std::vector<BinTotals> totals;             // of each bin of the curves; 0 for an empty bin
  std::vector<std::optional<Score>> scores;  // of each model; none without curves, and of the bounce map
  std::vector<OtherModel> other_models;
};

ReportData gather_report(const ReportFolder& folder, std::span<const ReportModel> models, const Rgb& albedo);

// Holds the light of one texel of the bake (not of the page's codes), irradiance over π.
struct ReportProbe {
  int x = 0, y = 0;
  double ao = 0, visibility = 0;
  std::optional<double> bounce;    // E at the albedo of the bounce map
  std::vector<double> irradiance;  // E_b at albedo 1
  std::vector<Rgb> models;         // E of each model
  Rgb truth{};                     // Σ ρᵇ E_b
};

// Returns up to 4 × 4 texels among every `stride`-th, to compare the page with. None without AO.
std::vector<ReportProbe> report_probes(const Bake& bake, std::span<const ReportModel> models, int stride,
                                       const Rgb& albedo);

}  // namespace hemibake
