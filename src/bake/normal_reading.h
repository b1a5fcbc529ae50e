// Reads the normal map of a height map and holds it against the heights.
#pragma once

#include <string>
#include <vector>

#include "bake/map_reading.h"
#include "bake/settings.h"
#include "core/grid.h"
#include "surface/surface.h"

namespace hemibake {

struct ReadNormals {
  Grid<glm::vec3> normals;
  Grid<float> lengths;  // as stored
  NormalReading reading;
  std::vector<std::string> warnings;  // settings in braces, as in SettingError
};

// Reads settings.normal_map and compares it with the heights; sets settings.normal_y and normal_encoding.
// surface: with central-difference normals. Throws InputError naming the file as io/image_io.h and
// decode_normal_map say; SettingError where the direction of green is not known, cannot be told from the
// heights or contradicts what the file records.
ReadNormals read_normals(MapSettings& settings, const Surface& surface);

// Returns the correlations in x and y: "x 0.98, y none".
std::string agreement_text(const SlopeAgreement& agreement);

}  // namespace hemibake
