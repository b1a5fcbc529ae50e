// Draws the pictures of `hemibake render`: each function adds those of one subject to a gallery, which
// records what is missing and why.
#pragma once

#include <array>
#include <string>

#include "lighting/shaded_scene.h"
#include "pictures/camera.h"
#include "pictures/gallery.h"

namespace hemibake {

struct PictureOptions {
  std::optional<double> exposure_ev;  // absent: chosen from the pictures
  int strip_bounces = 6;              // panels of the strip of bounces
  CameraOptions camera;
};

// Holds the light of the scene as something a shader has gives it.
struct SceneImage {
  std::string name, caption;
  Grid<glm::vec3> light;  // empty: not there
  std::string missing;    // why; empty where it is there, or a picture of another name shows the same
};

// Holds what all pictures that compare light show.
struct SceneImages {
  SceneImage ao_only, visibility_only, model, bounce_map;
  Grid<glm::vec3> truth;  // empty: not there
  double exposure_ev = 0;

  // Returns α alone, V alone, the model and the bounce map.
  std::array<const SceneImage*, 4> approximations() const {
    return {&ao_only, &visibility_only, &model, &bounce_map};
  }
};
SceneImages make_scene_images(const ShadedScene& scene, const PictureOptions& options);

// Adds ao_only, visibility_only, model, bounce_map, truth, and all beside each other.
void add_triptych(const SceneImages& shaded, Gallery& gallery);
// Adds the signed differences of each of them from the truth.
void add_differences(const SceneImages& shaded, Gallery& gallery);
// Adds the light of every bounce by itself, each at its own exposure.
void add_bounces(const ShadedScene& scene, const PictureOptions& options, Gallery& gallery);
// Adds the colour of reflected light that deepens with τ.
void add_saturation(const ShadedScene& scene, const SceneImages& shaded, Gallery& gallery);
// Adds α, V, the bounce map, bent normals and the energy map of the bake.
void add_planes(const ShadedScene& scene, Gallery& gallery);
// Adds every estimator's AO beside the bake's, and alchemy's before and after each pass of its blur.
void add_estimators(const ShadedScene& scene, Gallery& gallery);
// Adds AO only, model and truth on the surface seen by a camera, and the three with their errors on one
// sheet, `overview`.
void add_views(const ShadedScene& scene, const SceneImages& shaded, const PictureOptions& options,
               Gallery& gallery);

}  // namespace hemibake
