// A wall under a light, ready for pictures: what reaches its texels, and what a shader would make of it.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <string>

#include "core/grid.h"
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
  Grid<glm::vec3> sky;         // irradiance that nothing shades, per texel; empty: not known
  Grid<glm::vec3> sun;         // irradiance of the sun with its shadows; empty: no sun
  std::optional<Relit> truth;  // of sky and sun together
  std::optional<ShadingModel> model;
  std::optional<Surface> surface;  // where the map was found
};

// Light that leaves each texel, ρE/π, RGB; a white wall in the open under a sky of radiance 1 gives 1. AO and
// the model scale the sky's light only: nothing but its own shadow ever darkens the sun.
Grid<glm::vec3> shade_ao_only(const ShadedScene& wall);
Grid<glm::vec3> shade_model(const ShadedScene& wall);
Grid<glm::vec3> shade_truth(const ShadedScene& wall);
// The share of the truth that was reflected b times before its last time.
Grid<glm::vec3> shade_bounce(const ShadedScene& wall, size_t bounce);
// As the model, with irradiance relative to the open sky from `factor(α, ρ)`.
Grid<glm::vec3> shade_with(const ShadedScene& wall,
                           const std::function<double(double ao, double albedo)>& factor);

// A picture against the truth, in luminance; everything over the truth's mean.
struct PictureError {
  double bias = 0, rms = 0, largest = 0;
};
PictureError picture_error(const Grid<glm::vec3>& picture, const Grid<glm::vec3>& truth);

}  // namespace hemibake
