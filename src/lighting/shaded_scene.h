// Shades a lit scene: the truth, and what a shader makes of AO or a model.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "core/grid.h"
#include "lighting/albedo.h"
#include "lighting/relight.h"
#include "surface/surface.h"
#include "transport/baked_planes.h"

namespace hemibake {

// E/π over all bounces, F₀, F₁ and τ of a fitted model (model/model.h), for α and ρ in 0..1.
struct ShadingModel {
  std::string name;
  std::function<double(double ao, double albedo)> total;
  std::function<double(double ao)> direct, first_bounce, bounce_ratio;
};

struct ShadedScene {
  Bake bake;
  Albedo albedo;
  Grid<glm::vec3> sky;         // unshaded irradiance per texel; empty: not known
  Grid<glm::vec3> sun;         // irradiance of the sun with its shadows; empty: no sun
  std::optional<Relit> truth;  // of sky and sun together
  std::optional<ShadingModel> model;
  std::optional<Surface> surface;  // if the map was found
};

// Shading returns the light that leaves each texel, ρE/π, RGB: 1 for a white scene in the open under a sky of
// radiance 1. AO and the model scale the light of the sky only: the sun is darkened by its own shadow alone.

// Shades the sky by α.
Grid<glm::vec3> shade_ao_only(const ShadedScene& scene);
// Shades the sky by the model, which must be there.
Grid<glm::vec3> shade_model(const ShadedScene& scene);
// Shades by the truth, which must be there.
Grid<glm::vec3> shade_truth(const ShadedScene& scene);
// Shades by the part of the truth that was reflected `bounce` times before its last reflection.
Grid<glm::vec3> shade_bounce(const ShadedScene& scene, size_t bounce);
// Shades the sky by a factor of α and ρ: irradiance relative to that of the open sky.
Grid<glm::vec3> shade_with(const ShadedScene& scene,
                           const std::function<double(double ao, double albedo)>& factor);

// Differences in luminance over the mean luminance of the truth.
struct PictureError {
  double bias = 0, rms = 0, largest = 0;
};

// Compares a picture with the truth, pixel by pixel. Returns zeros if the truth is black.
PictureError picture_error(const Grid<glm::vec3>& picture, const Grid<glm::vec3>& truth);

}  // namespace hemibake
