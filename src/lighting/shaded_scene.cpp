#include "lighting/shaded_scene.h"

#include <algorithm>
#include <cmath>

#include "core/color.h"
#include "core/constants.h"
#include "core/statistics.h"

namespace hemibake {
namespace {

// Returns ρE/π. irradiance: E as irradiance(texel, channel).
template <class Irradiance>
Grid<glm::vec3> shade(const ShadedScene& scene, const Irradiance& irradiance) {
  Grid<glm::vec3> light(scene.bake.width, scene.bake.height);
  for (size_t i = 0; i < light.size(); ++i) {
    const glm::vec3 albedo = scene.albedo.at(i);
    for (int c = 0; c < 3; ++c)
      light[i][c] = static_cast<float>(static_cast<double>(albedo[c]) * irradiance(i, c) / kPi);
  }
  return light;
}

}  // namespace

Grid<glm::vec3> shade_with(const ShadedScene& scene,
                           const std::function<double(const TexelInputs& inputs, double albedo)>& factor) {
  return shade(scene, [&](size_t i, int c) {
    const double of_sky = factor(texel_inputs(scene.bake, i), static_cast<double>(scene.albedo.at(i)[c]));
    const double sun = scene.sun.empty() ? 0.0 : static_cast<double>(scene.sun[i][c]);
    return of_sky * static_cast<double>(scene.sky[i][c]) + sun;
  });
}

Grid<glm::vec3> shade_ao_only(const ShadedScene& scene) {
  return shade_with(scene, [](const TexelInputs& inputs, double) { return inputs.ao; });
}

Grid<glm::vec3> shade_visibility_only(const ShadedScene& scene) {
  return shade_with(scene, [](const TexelInputs& inputs, double) { return inputs.visibility; });
}

Grid<glm::vec3> shade_model(const ShadedScene& scene, const AnyModel& model) {
  return shade_with(scene, [&](const TexelInputs& inputs, double albedo) {
    return model_irradiance(model, inputs, albedo);
  });
}

Grid<glm::vec3> shade_truth(const ShadedScene& scene) {
  return shade(scene, [&](size_t i, int c) { return static_cast<double>(scene.truth->total[i][c]); });
}

Grid<glm::vec3> shade_bounce(const ShadedScene& scene, size_t bounce) {
  return shade(scene,
               [&](size_t i, int c) { return static_cast<double>(scene.truth->bounces[bounce][i][c]); });
}

PictureError picture_error(const Grid<glm::vec3>& picture, const Grid<glm::vec3>& truth) {
  double sum_truth = 0, sum = 0, sum_squared = 0;
  PictureError error;
  for (size_t i = 0; i < truth.size(); ++i) {
    const double expected = luminance(glm::dvec3(truth[i]));
    const double difference = luminance(glm::dvec3(picture[i])) - expected;
    sum_truth += expected;
    sum += difference;
    sum_squared += difference * difference;
    error.largest = std::max(error.largest, std::abs(difference));
  }
  const auto count = static_cast<double>(truth.size());
  const double mean = sum_truth / count;
  if (!(mean > 0)) return {};
  return {sum / count / mean, std::sqrt(sum_squared / count) / mean, error.largest / mean};
}

}  // namespace hemibake
