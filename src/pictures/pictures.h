// What `hemibake render` draws: each function adds the pictures of one subject to a gallery, and says there
// what is missing and why.
#pragma once

#include "lighting/shaded_scene.h"
#include "pictures/camera.h"
#include "pictures/gallery.h"

namespace hemibake {

struct PictureOptions {
  std::optional<double> exposure_ev;  // absent: chosen from the pictures
  int strip_bounces = 6;              // panels of the strip of bounces
  CameraOptions camera;
};

// AO only, model and truth, made once for all pictures that show them. Empty where they cannot be made.
struct SceneImages {
  Grid<glm::vec3> ao_only, model, truth;
  double exposure_ev = 0;
};
SceneImages make_scene_images(const ShadedScene& wall, const PictureOptions& options);

// ao_only, model, truth, and the three beside each other.
void add_triptych(const ShadedScene& wall, const SceneImages& shaded, Gallery& gallery);
// Signed differences of AO only and of the model from the truth.
void add_differences(const SceneImages& shaded, Gallery& gallery);
// The light of every bounce by itself, each at its own exposure.
void add_bounces(const ShadedScene& wall, const PictureOptions& options, Gallery& gallery);
// How the colour of the wall deepens with τ.
void add_saturation(const ShadedScene& wall, const SceneImages& shaded, Gallery& gallery);
// AO, bent normals and the energy map of the bake.
void add_planes(const ShadedScene& wall, Gallery& gallery);
// Every estimator's AO beside the bake's; alchemy's before and after each pass of its blur.
void add_estimators(const ShadedScene& wall, Gallery& gallery);
// AO only, model and truth on the surface itself, seen by a camera; and the three with their errors on one
// sheet, `overview`.
void add_views(const ShadedScene& wall, const SceneImages& shaded, const PictureOptions& options,
               Gallery& gallery);

}  // namespace hemibake
