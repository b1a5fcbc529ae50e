// FIT.json: fits by name, and their provenance. src/io/README.md describes the file.
#pragma once

#include <filesystem>
#include <vector>

#include "fitting/fit.h"
#include "fitting/fitted_model.h"
#include "fitting/map_comparison.h"
#include "io/provenance.h"

namespace hemibake {

// The mean escape share m of one of the maps that were fitted; none where its curves did not tell.
struct MapEscape {
  std::string map;
  std::optional<double> mean_escape;  // 0..1
};

struct FitFile {
  std::vector<NamedFit> fits;
  Provenance provenance;
  MapComparison comparison;             // without maps where it is unknown; written, but not read back
  std::vector<MapEscape> escapes = {};  // read from the maps of the file, not written
};

nlohmann::ordered_json json_from_fits(const FitFile& file);

// Throws InputError "FILE: F0/points is …, expected …". path: for errors only.
FitFile fits_from_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

// Returns lines for the head of a model's shader text: version, formulas with their constants, name of the
// input without its folder. Throws InputError where a fit of the model is missing.
std::vector<std::string> model_origin(const FitFile& file, ModelKind kind);

FitFile read_fits(const std::filesystem::path& path);
void write_fits(const std::filesystem::path& path, const FitFile& file);

}  // namespace hemibake
