// Models that give irradiance over all bounces from one number per texel, as a shader uses them.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "curves/curves.h"
#include "model/model.h"
#include "trade/errors.h"
#include "trade/trade_run.h"

namespace hemibake {

// Models with constants fitted to the map's own curves: the best each can do. Absent where the map has too
// few AO values for a fit (flat ground has one).
struct FittedModels {
  std::optional<Mayaux2018Model> eq12;  // the formulas of 2018
  std::optional<BoundedModel> bounded;
};

// Fits the models of 2018 and the bounded one at bin centres, unweighted. Throws Cancelled.
FittedModels fit_light_models(const Curves& curves);

struct LightModel {
  const char* name;
  const char* description;
};

// Lists all models, in the order of trade.json:
//   plain                          E/π = AO
//   f0                             F₀(AO) of Mayaux 2018, no bounces
//   eq12-published, eq12-refitted  eq. 12 of Mayaux 2018
//   bounded                        BoundedModel
//   jimenez                        the cubic of Jimenez et al. 2016
std::span<const LightModel> light_models();

struct LightModelErrors {
  std::string model;
  std::array<ErrorStatistics, kJudgedAlbedos.size()> error;  // of E/π at each of kJudgedAlbedos
};

// Evaluates every model that has its constants on the AO of `planes`, against the true E/π. The cubic takes
// E₀/π where the run has it, all others α where the run has it; else each takes the plane there is.
std::vector<LightModelErrors> light_model_errors(const RunPlanes& planes, const FittedModels& fitted,
                                                 const RunPlanes& truth);

}  // namespace hemibake
