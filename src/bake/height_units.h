// Heights in metres and texel sizes: what a file and the settings together say.
#pragma once

#include "bake/settings.h"
#include "core/grid.h"
#include "io/height_file.h"

namespace hemibake {

// Why map values are metres, or are 0..1.
enum class UnitReason {
  kSaid,        // by the settings
  kRaster,      // the file is terrain
  kSigned,      // integers of a type that goes below 0
  kWideFloats,  // floats that range over more than 2
  kAmplitude,   // the same, but an amplitude scales them
  kDefault      // 0..1
};

// Heights and spacing of a map.
struct HeightUnits {
  UnitReason reason = UnitReason::kDefault;
  double stored_low = 0, stored_high = 0;  // range of the values: 0..1, or as stored where these are metres
  double lowest_m = 0, highest_m = 0;      // over the map's own zero
  double texel_x_m = 0, texel_y_m = 0;     // width and height of a texel
  bool texel_from_file = false;            // by the place, which the settings did not override
  bool texel_overrides_file = false;       // the file has a place too
};

// Resolves the units of a map: settings.heights, size_m and amplitude_m are set afterwards, and texel_m where
// texels are not square; a bake that records them reads the same surface again. Scales the values of the file
// so that settings.amplitude_m times a value is its height: metres become values as stored, and heights that
// fall with the value are turned over. Throws SettingError (without a file name) for settings that contradict
// the file.
HeightUnits resolve_units(HeightFile& file, MapSettings& settings);

}  // namespace hemibake
