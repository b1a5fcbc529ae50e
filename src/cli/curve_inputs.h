// Finds and reads the curves that a command line names: files, bakes and folders of maps' results.
#pragma once

#include <string>
#include <vector>

#include "fitting/map_comparison.h"

namespace hemibake {

struct CurveInput {
  std::string path;  // of the curves or the bake
  MapCurves map;     // its name: the file's, or the folder's of a curves.csv or bake.exr
};

// Reads curves in the order of `arguments`, within a folder by name. An argument is a CSV of curves, a bake
// (EXR; its curves over α are made) or a folder: that of one map with curves.csv or bake.exr, or one with
// such folders, with CSVs and with bakes. Files of a folder that are neither are named in `skipped`, a line
// each. Throws InputError for a folder without maps and for two maps of one name.
std::vector<CurveInput> read_curve_inputs(const std::vector<std::string>& arguments,
                                          std::vector<std::string>& skipped);

// Returns the maps of the inputs.
std::vector<MapCurves> maps_of(const std::vector<CurveInput>& inputs);

}  // namespace hemibake
