// Tells what a map was understood as, and what makes that doubtful.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/height_units.h"
#include "bake/settings.h"
#include "core/grid.h"
#include "io/height_file.h"
#include "surface/normals.h"
#include "surface/surface.h"

namespace hemibake {

// Source of what is known about the green channel of a normal map.
enum class NormalYSource { kSaid, kFile, kHeights };

// Holds what a normal map was understood as.
struct NormalReading {
  std::vector<std::string> channels;
  NormalEncoding encoding = NormalEncoding::kLinear;
  NormalY y = NormalY::kUp;
  NormalYSource y_from = NormalYSource::kSaid;
  double mean_length = 1;    // of the vectors as stored
  SlopeAgreement agreement;  // with the slopes of the heights
};

// Holds what a map was understood as. Settings are named in braces in the warnings, as in SettingError.
struct MapReading {
  HeightFile file;  // without its values and holes
  HeightUnits units;
  size_t holes = 0;                      // texels that had no height
  std::optional<NormalReading> normals;  // of a normal map
  double step_m = 0;                     // height of one step of 8-bit values; 0: there are more bits
  std::vector<std::string> warnings;
};

// Returns warnings about values that stand out: more than ten times the range of all others away from them.
// Integers of 0..1 often have a floor of black and a ceiling of white: there only few texels count, elsewhere
// any number of one value, as −9999 in terrain. file: as read, holes apart. said_metres: although its
// integers are over their range.
std::vector<std::string> outlier_warnings(const HeightFile& file, bool said_metres);

// Returns warnings about a surface that can hardly be meant: flat, nearly flat, steeper than 85° in half of
// its texels. `surface` has central-difference normals.
std::vector<std::string> surface_warnings(const MapReading& reading, const MapSettings& settings,
                                          const Surface& surface);

}  // namespace hemibake
