// Makes the scene that `hemibake render` draws: a bake, an albedo and a light.
#pragma once

#include <optional>
#include <string>

#include "cli/render_options.h"
#include "io/bake_file.h"
#include "lighting/shaded_scene.h"

namespace hemibake {

struct RenderedScene {
  ShadedScene scene;
  std::string no_map, no_model;                  // why there is none; empty: there is one
  std::optional<PictureError> projection_error;  // see LitScene
};

// Reads the files that the options name and lights the scene. Looks for the map of the bake; throws
// InputError if the light asked for needs the map and it is not there, and for everything that cannot be
// used.
RenderedScene shade_scene(const RenderOptions& options, BakeFile file, const Context& context);

}  // namespace hemibake
