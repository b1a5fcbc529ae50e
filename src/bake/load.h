// The map of a bake, read and made a surface.
#pragma once

#include <optional>
#include <string>

#include "bake/map_reading.h"
#include "bake/settings.h"
#include "core/grid.h"
#include "io/height_file.h"
#include "surface/surface.h"

namespace hemibake {

// SHA-256 of the files read, 64 hexadecimal digits each; empty: none.
struct MapHashes {
  std::string map, normal_map;
};

struct LoadedMap {
  MapSettings settings;  // resolved: a bake that records them reads the same surface again
  MapReading reading;
  Surface surface;
  // The map's, as the march needs them: metres per unit of map value (0: values are metres), and the height
  // that the surface's 0 stands for.
  double amplitude_m = 0, lowest_m = 0;
  Grid<float> normal_lengths;  // as the normal map stores them; empty unless they are to be followed
  MapHashes sha256;
  std::optional<GeoPlace> place;  // of the map on the earth
};

// Hashes the files of a map. Throws InputError where one cannot be read.
MapHashes hash_files(const MapSettings& settings);

// Reads, resolves units, filters, scales; takes normals as the settings say, their lengths only where they
// are to be kept; says what was understood. Throws InputError naming the file.
LoadedMap load_map(const MapSettings& settings, NormalLength lengths = NormalLength::kUnit);

}  // namespace hemibake
