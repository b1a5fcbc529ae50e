// A bake, an albedo and a light, as the wall that the pictures show.
#pragma once

#include <nlohmann/json.hpp>

#include "cli/render_options.h"
#include "io/bake_file.h"
#include "lighting/scene.h"

namespace hemibake {

struct RenderedScene {
  ShadedScene wall;
  nlohmann::ordered_json light;  // how it was lit, and how well that is known
};

nlohmann::ordered_json json_from_error(const PictureError& error);

// Reads what the options name. Finds the map of the bake where it can; throws InputError where light asked
// for needs the map and it is not there, and for everything that cannot be used.
RenderedScene shade_scene(const RenderOptions& options, BakeFile file, const Context& context);

}  // namespace hemibake
