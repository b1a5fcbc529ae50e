#include "trade/light_models.h"

#include <functional>
#include <stdexcept>

#include "core/context.h"
#include "core/error.h"
#include "fitting/models.h"

namespace hemibake {
namespace {

constexpr std::array<LightModel, 6> kLightModels{{
    {"plain", "E/pi = AO, whatever the albedo"},
    {"f0", "F0(AO) of 2018, direct light only"},
    {"eq12-published", "eq. 12 of 2018 with its published constants, kept in 0..1"},
    {"eq12-refitted", "eq. 12 of 2018 fitted to this map, kept in 0..1"},
    {"bounded", "the bounded model fitted to this map"},
    {"jimenez", "the cubic of Jimenez et al. 2016"},
}};

// Returns E/π of an AO at an albedo.
using Evaluate = std::function<double(double ao, double albedo)>;

// Returns the model's function; empty where its constants are absent.
Evaluate evaluator(const std::string& model, const FittedModels& fitted) {
  if (model == "plain") return [](double ao, double) { return ao; };
  if (model == "f0") return [m = GuardedModel{}](double ao, double) { return m.direct(ao); };
  if (model == "eq12-published")
    return [m = GuardedModel{}](double ao, double albedo) { return m.total(ao, albedo); };
  if (model == "eq12-refitted" && fitted.eq12)
    return [m = GuardedModel{*fitted.eq12}](double ao, double albedo) { return m.total(ao, albedo); };
  if (model == "bounded" && fitted.bounded)
    return [m = *fitted.bounded](double ao, double albedo) { return m.total(ao, albedo); };
  if (model == "jimenez")
    return [m = JimenezModel{}](double ao, double albedo) { return m.total(ao, albedo); };
  return {};
}

// Fits the model at bin centres; empty where the curves do not allow it.
std::vector<NamedFit> fits_or_none(const char* model, const Curves& curves) {
  try {
    return fit_model(model, curves, Abscissa::kCenter, Weights::kNone);
  } catch (const std::runtime_error&) {
    throw_if_cancelled();
    return {};
  }
}

}  // namespace

FittedModels fit_light_models(const Curves& curves) {
  FittedModels fitted;
  const std::vector<NamedFit> published = fits_or_none("published", curves);
  if (published.size() == 2)
    fitted.eq12 =
        Mayaux2018Model{parameter_value(published[0].fit, "k"), parameter_value(published[0].fit, "e"),
                        parameter_value(published[1].fit, "A"), parameter_value(published[1].fit, "B")};
  const std::vector<NamedFit> bounded = fits_or_none("bounded", curves);
  if (bounded.size() == 2)
    fitted.bounded =
        BoundedModel{parameter_value(bounded[0].fit, "k0"), parameter_value(bounded[0].fit, "k1"),
                     parameter_value(bounded[1].fit, "q"), parameter_value(bounded[1].fit, "d")};
  return fitted;
}

std::span<const LightModel> light_models() { return kLightModels; }

std::vector<LightModelErrors> light_model_errors(const RunPlanes& planes, const FittedModels& fitted,
                                                 const RunPlanes& truth) {
  std::vector<LightModelErrors> results;
  if (planes.uniform.empty() && planes.cosine.empty()) return results;
  for (const LightModel& model : kLightModels) {
    const Evaluate evaluate = evaluator(model.name, fitted);
    if (!evaluate) continue;
    const bool wants_cosine = std::string(model.name) == "jimenez";
    const Grid<float>& wanted = wants_cosine ? planes.cosine : planes.uniform;
    const Grid<float>& ao = wanted.empty() ? (wants_cosine ? planes.uniform : planes.cosine) : wanted;
    LightModelErrors result{model.name, {}};
    std::vector<float> light(ao.size());
    for (size_t a = 0; a < kJudgedAlbedos.size(); ++a) {
      for (size_t i = 0; i < light.size(); ++i)
        light[i] = static_cast<float>(evaluate(static_cast<double>(ao[i]), kJudgedAlbedos[a]));
      result.error[a] = error_of(light, truth.all_bounces[a].values, planes.known.values);
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace hemibake
