// What a report says, as data for its page.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "model/model.h"
#include "report/html_folder.h"
#include "report/html_planes.h"

namespace hemibake {

// A model that the page offers.
struct ReportModel {
  std::string id;        // bounded, published or notes
  std::string title;     // for people
  BoundedModel bounded;  // used where id is bounded
  GuardedModel guarded;  // used otherwise
  std::vector<std::string> origin;

  double total(double ao, double albedo) const {
    return id == "bounded" ? bounded.total(ao, albedo) : guarded.total(ao, albedo);
  }
};

// Those fitted to the folder's curves, best first, then the one of 2018 with its published constants.
std::vector<ReportModel> report_models(const ReportFolder& folder);

using Rgb = std::array<double, 3>;

// Everything but the planes: settings, curves, models with their shader texts and errors, checks, sweep,
// trade study. What the folder does not have is null. albedo: what the page opens with, 0..1.
nlohmann::ordered_json report_data(const ReportFolder& folder, std::span<const ReportModel> models,
                                   const PackedPlanes& planes, const Rgb& albedo);

// Light of some texels of the bake (not of its codes), for comparison with the page: α, E_b/π, and relative
// to an open surface at `albedo` each model and the truth Σ ρᵇ E_b/π.
nlohmann::ordered_json report_probes(const Bake& bake, std::span<const ReportModel> models, int stride,
                                     const Rgb& albedo);

}  // namespace hemibake
