// What a shader makes of an AO: irradiance over all bounces from one number per texel.
#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "curves/curves.h"
#include "model/model.h"
#include "trade/errors.h"
#include "trade/trade_run.h"

namespace hemibake {

// Constants fitted to the curves of the map itself: the best its models can do. Absent where the map has too
// few AO values for a fit (flat ground has one).
struct FittedModels {
  std::optional<Mayaux2018Model> eq12;  // the formulas of 2018
  std::optional<BoundedModel> bounded;
};

FittedModels fit_light_models(const Curves& curves);

nlohmann::ordered_json json_from_fitted(const FittedModels& fitted);
FittedModels fitted_from_json(const nlohmann::ordered_json& json);

struct LightModel {
  const char* name;
  const char* description;
};

// plain: E/π = AO. f0: F₀(AO) of 2018, no bounces. eq12-published, eq12-refitted: notes eq. 12. bounded: of
// this project. jimenez: the cubic of 2016.
std::span<const LightModel> light_models();

struct LightModelErrors {
  std::string model;
  std::array<ErrorStatistics, kJudgedAlbedos.size()> error;  // of E/π at each of kJudgedAlbedos
};

// Every model that has its constants, on the AO of `planes` against the true E/π. The cubic takes E₀/π where
// the run has it, all others α where the run has it; else each is given what there is, as a shader would be.
std::vector<LightModelErrors> light_model_errors(const RunPlanes& planes, const FittedModels& fitted,
                                                 const RunPlanes& truth);

}  // namespace hemibake
