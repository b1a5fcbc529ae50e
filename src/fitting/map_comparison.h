// Fits one set of constants to several maps, and says which model carries best from map to map.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fitting/fit.h"
#include "fitting/prediction.h"

namespace hemibake {

struct MapCurves {
  std::string name;
  Curves curves;
};

// Holds how one model does on one map.
struct ModelOnMap {
  std::vector<NamedFit> fits;     // to this map alone; none where its curves do not suffice
  std::optional<Score> own;       // errors of these fits
  Score shared;                   // errors of the constants for all maps
  std::optional<Score> held_out;  // errors of constants fitted to all the other maps; none for a single map
};

struct MapErrors {
  std::string name;
  std::optional<double> mean_escape;  // m of its curves (curves/curves.h)
  std::vector<ModelOnMap> models;     // in the order of MapComparison::models
};

struct MapComparison {
  std::vector<std::string> models;  // those of fit_models that predict a total
  std::vector<MapErrors> maps;
  // Mean over the maps of each model's held-out rms; none where it is unknown on one of them.
  std::vector<std::optional<double>> held_out_rms;
  std::string winner;  // the model of least held-out rms; empty for a single map
};

struct MapFits {
  std::vector<NamedFit> fits;  // one set of constants for all maps, of every model asked for
  MapComparison comparison;
};

// Fits `models`, names of fit_models, to the bins of all `maps` (at least one), to each and to all but each.
// Throws what fit_model throws for the fits to all; others that fail are left out.
MapFits fit_maps(std::span<const std::string> models, std::span<const MapCurves> maps, Abscissa abscissa,
                 Weights weights);

}  // namespace hemibake
