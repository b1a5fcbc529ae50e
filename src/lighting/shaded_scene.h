// Shades a lit scene: the truth, and what a shader makes of AO or a model.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "core/grid.h"
#include "lighting/albedo.h"
#include "lighting/relight.h"
#include "lighting/texel_model.h"
#include "surface/surface.h"
#include "transport/baked_planes.h"

namespace hemibake {

struct ShadingModel {
  std::string name;
  AnyModel model;
};

struct ShadedScene {
  Bake bake;
  Albedo albedo;
  Grid<glm::vec3> sky;         // unshaded irradiance per texel; empty: not known
  Grid<glm::vec3> sun;         // irradiance of the sun with its shadows; empty: no sun
  std::optional<Relit> truth;  // of sky and sun together
  std::optional<ShadingModel> model;
  std::optional<Surface> surface;  // of the bake's texels, if the map was found
  bool is_cropped = false;         // the map goes on around the bake's texels
};

// Shading returns the light that leaves each texel, ρE/π, RGB: 1 for a white scene in the open under a sky of
// radiance 1. α, V and the model scale the light of the sky only: the sun is darkened by its own shadow
// alone.

// Shades the sky by α.
Grid<glm::vec3> shade_ao_only(const ShadedScene& scene);
// Shades the sky by V, which the bake must give.
Grid<glm::vec3> shade_visibility_only(const ShadedScene& scene);
// Shades the sky by a model whose planes the bake holds. Each texel counts with its own albedo.
Grid<glm::vec3> shade_model(const ShadedScene& scene, const AnyModel& model);
// Shades by the truth, which must be there.
Grid<glm::vec3> shade_truth(const ShadedScene& scene);
// Shades by the part of the truth that was reflected `bounce` times before its last reflection.
Grid<glm::vec3> shade_bounce(const ShadedScene& scene, size_t bounce);
// Shades the sky by a factor of what a texel holds and of ρ: irradiance relative to that of the open sky.
Grid<glm::vec3> shade_with(const ShadedScene& scene,
                           const std::function<double(const TexelInputs& inputs, double albedo)>& factor);

// Differences in luminance over the mean luminance of the truth.
struct PictureError {
  double bias = 0, rms = 0, largest = 0;
};

// Compares a picture with the truth, pixel by pixel. Returns zeros if the truth is black.
PictureError picture_error(const Grid<glm::vec3>& picture, const Grid<glm::vec3>& truth);

}  // namespace hemibake
