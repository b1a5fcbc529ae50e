// The conventions of engines: names, green channel and packing (src/textures/README.md has the sources).
#pragma once

#include <array>

#include "textures/settings.h"

namespace hemibake {

struct EngineConventions {
  NormalY normal_y = NormalY::kUp;
  Packing packing = Packing::kNone;
  std::array<std::string, kTextureKinds> suffixes;
};

// Returns the conventions of an engine; without one: green up, nothing packed, suffixes as the textures are
// named.
EngineConventions engine_conventions(std::optional<Engine> engine);

}  // namespace hemibake
