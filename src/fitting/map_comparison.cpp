#include "fitting/map_comparison.h"

#include <cmath>

#include "core/error.h"
#include "fitting/models.h"

namespace hemibake {
namespace {

// Holds how to fit, whatever the model and the map.
struct FitChoice {
  Abscissa abscissa;
  Weights weights;
};

// Joins the bins of all maps but the one at `left_out`; of all where that is none of them.
Curves pool_all_but(std::span<const MapCurves> maps, size_t left_out) {
  std::vector<Curves> sets;
  for (size_t i = 0; i < maps.size(); ++i)
    if (i != left_out) sets.push_back(maps[i].curves);
  return pool_curves(sets);
}

// Returns the fits, none where the curves do not suffice.
std::vector<NamedFit> fits_or_none(const FitModel& model, const Curves& curves, const FitChoice& choice) {
  try {
    return fit_model(model.name, curves, choice.abscissa, choice.weights);
  } catch (const InputError&) {
  } catch (const CheckError&) {
  }
  return {};
}

std::optional<Score> score_fits(const FitModel& model, const std::vector<NamedFit>& fits,
                                const Curves& curves) {
  if (fits.empty()) return std::nullopt;
  return score_prediction(model.predict(fits), curves);
}

// Adds the errors of one model to every map. shared: its fits to all of them.
void add_model(const FitModel& model, const std::vector<NamedFit>& shared, std::span<const MapCurves> maps,
               const FitChoice& choice, MapComparison& comparison) {
  double sum = 0;
  bool complete = maps.size() > 1;
  for (size_t i = 0; i < maps.size(); ++i) {
    const Curves& curves = maps[i].curves;
    ModelOnMap result;
    result.fits = fits_or_none(model, curves, choice);
    result.own = score_fits(model, result.fits, curves);
    result.shared = score_prediction(model.predict(shared), curves);
    if (maps.size() > 1)
      result.held_out = score_fits(model, fits_or_none(model, pool_all_but(maps, i), choice), curves);
    complete = complete && result.held_out;
    if (result.held_out) sum += result.held_out->rms;
    comparison.maps[i].models.push_back(std::move(result));
  }
  comparison.models.emplace_back(model.name);
  comparison.held_out_rms.push_back(complete ? std::optional(sum / static_cast<double>(maps.size()))
                                             : std::nullopt);
}

std::string best_of(const MapComparison& comparison) {
  std::string best;
  double least = HUGE_VAL;
  for (size_t m = 0; m < comparison.models.size(); ++m) {
    const std::optional<double> rms = comparison.held_out_rms[m];
    if (!rms || *rms >= least) continue;
    least = *rms;
    best = comparison.models[m];
  }
  return best;
}

}  // namespace

MapFits fit_maps(std::span<const std::string> models, std::span<const MapCurves> maps, Abscissa abscissa,
                 Weights weights) {
  MapFits result;
  for (const MapCurves& map : maps) result.comparison.maps.push_back({map.name, mean_escape(map.curves), {}});
  const Curves all = pool_all_but(maps, maps.size());
  for (const std::string& name : models) {
    const std::vector<NamedFit> fits = fit_model(name, all, abscissa, weights);
    const FitModel& model = fit_model_called(name);
    if (model.predict) add_model(model, fits, maps, {abscissa, weights}, result.comparison);
    result.fits.insert(result.fits.end(), fits.begin(), fits.end());
  }
  result.comparison.winner = best_of(result.comparison);
  return result;
}

}  // namespace hemibake
