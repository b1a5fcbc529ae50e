#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/color.h"
#include "core/constants.h"
#include "core/statistics.h"
#include "estimators/estimator.h"
#include "pictures/color_map.h"
#include "pictures/pictures.h"
#include "textures/light.h"

namespace hemibake {
namespace {

constexpr int kPanelSide = 288;

Panel grey_panel(const Grid<float>& values, std::string caption) {
  const Grid<float> small = scaled(values, kPanelSide);
  Grid<glm::vec3> shown(small.width, small.height);
  for (size_t i = 0; i < shown.size(); ++i) shown[i] = glm::vec3(small[i]);
  return {shown, std::move(caption)};
}

Grid<glm::vec3> as_colors(const Grid<glm::vec3>& vectors) {
  Grid<glm::vec3> shown = vectors;
  for (glm::vec3& v : shown.values) v = (v + 1.0f) / 2.0f;
  return shown;
}

Grid<float> over_pi(const Grid<float>& values) {
  Grid<float> result = values;
  for (float& value : result.values) value = static_cast<float>(static_cast<double>(value) / kPi);
  return result;
}

// Returns V of every texel; empty where the bake does not give it.
Grid<float> visibility_of(const Bake& bake) {
  if (!has_visibility(bake)) return {};
  Grid<float> visibility(bake.width, bake.height);
  for (size_t i = 0; i < visibility.size(); ++i) visibility[i] = static_cast<float>(visibility_at(bake, i));
  return visibility;
}

// "disk: rms 0.021 to V"
std::string estimate_caption(const std::string& name, const Grid<float>& ao, AoKind kind, const Bake& bake) {
  const Grid<float> truth = kind == AoKind::kUniform ? bake.visible_fraction : visibility_of(bake);
  if (truth.empty()) return name;
  return fmt::format("{}: rms {:.3f} to {}", name, rms_difference(ao.values, truth.values),
                     kind == AoKind::kUniform ? "alpha" : "V");
}

}  // namespace

void add_planes(const ShadedScene& scene, Gallery& gallery) {
  const Bake& bake = scene.bake;
  const auto add_values = [&](const char* name, const char* what, const Grid<float>& values) {
    if (values.empty()) return gallery.report_missing(name, std::string("the bake holds no ") + what);
    gallery.add_values(name, values);
  };
  add_values("ao", "ao", bake.visible_fraction);
  add_values("visibility", "visibility", visibility_of(bake));
  add_values("bounce", "bounce map", bake.bounce);
  if (bake.bent_normals.empty())
    gallery.report_missing("bent_normals", "the bake holds no bent normals");
  else
    gallery.add_vectors("bent_normals", bake.bent_normals, as_colors(bake.bent_normals));
  if (bake.total.empty()) return gallery.report_missing("energy", "the bake holds no total");
  const Grid<float> energy = over_pi(bake.total);
  const float least = *std::ranges::min_element(energy.values);
  // From the tenth below the least, so that what is missing shows.
  const double low = std::clamp(std::floor(static_cast<double>(least) * 10) / 10, 0.0, 0.9);
  gallery.add_numbers(
      "energy", energy,
      {sequential_color, low, 1, 0, "all bounces at albedo 1 over pi: 1 where no light is missing"});
}

void add_estimators(const ShadedScene& scene, Gallery& gallery) {
  if (scene.bake.visible_fraction.empty())
    return gallery.report_missing("estimators", "the bake holds no ao to compare with");
  if (!scene.surface)
    return gallery.report_missing("estimators", "the map of the bake was not found, or is another now");
  if (scene.is_cropped)
    return gallery.report_missing("estimators", "the bake is cropped, and what was cropped occludes it");
  std::array<std::vector<Panel>, 2> rows;
  rows[0].push_back(grey_panel(scene.bake.visible_fraction, "the bake, alpha"));
  const EstimatorOptions options;
  for (const Estimator& estimator : estimators()) {
    if (estimator.name == std::string_view("alchemy")) continue;
    const Estimate estimate = estimator.estimate(*scene.surface, options);
    gallery.add_values(fmt::format("estimator_{}", estimator.name), estimate.ao);
    rows[0].push_back(
        grey_panel(estimate.ao, estimate_caption(estimator.name, estimate.ao, estimate.kind, scene.bake)));
  }
  // From straight above a pixel is a texel, so that the passes of the picture are passes over the map.
  const AlchemyOptions& alchemy = options.alchemy;
  const AlchemyImages passes = alchemy_images(orthographic_buffer(*scene.surface, alchemy.camera_height_m),
                                              alchemy, alchemy_radius_m(*scene.surface, alchemy));
  const auto add_pass = [&](const char* name, const char* caption, const Grid<float>& ao) {
    gallery.add_values(name, ao);
    rows[1].push_back(grey_panel(ao, estimate_caption(caption, ao, AoKind::kCosine, scene.bake)));
  };
  if (has_visibility(scene.bake)) rows[1].push_back(grey_panel(visibility_of(scene.bake), "the bake, V"));
  add_pass("estimator_alchemy_0", "alchemy, raw", passes.raw);
  add_pass("estimator_alchemy_1", "along rows", passes.blurred_rows);
  add_pass("estimator_alchemy_2", "and columns", passes.blurred);
  gallery.add_figure("estimators", rows);
}

}  // namespace hemibake
