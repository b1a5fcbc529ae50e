#include "pictures/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/color.h"
#include "core/constants.h"
#include "pictures/color_map.h"

namespace hemibake {
namespace {

constexpr const char* kDifferenceLabel = "luminance minus ground truth; blue: too dark, red: too bright";
constexpr int kPanelSide = 384;       // longest side of a panel in a figure
constexpr int kStripSide = 200;       // of one in a strip
constexpr double kScaleShare = 0.98;  // of the pixels, that a scale of differences takes in

Panel light_panel(const Grid<glm::vec3>& linear, int side, double exposure_ev, std::string caption) {
  Clipping shown_here_only;  // the picture by itself reports its own
  return {encode_srgb(scaled(linear, side), exposure_ev, shown_here_only), std::move(caption)};
}

Grid<glm::vec3> difference(const Grid<glm::vec3>& a, const Grid<glm::vec3>& b) {
  Grid<glm::vec3> result = a;
  for (size_t i = 0; i < result.size(); ++i) result[i] -= b[i];
  return result;
}

Grid<float> luminance_of(const Grid<glm::vec3>& linear) {
  Grid<float> values(linear.width, linear.height);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(luminance(glm::dvec3(linear[i])));
  return values;
}

// Returns ± the round number that takes in kScaleShare of all values.
ColorScale difference_scale(std::span<const Grid<float>> differences) {
  std::vector<float> sizes;
  for (const Grid<float>& values : differences)
    for (const float value : values.values) sizes.push_back(std::abs(value));
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(kScaleShare * (sizes.size() - 1));
  std::nth_element(sizes.begin(), place, sizes.end());
  const double most = round_scale(static_cast<double>(*place));
  return {diverging_color, -most, most, -1, kDifferenceLabel};
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

std::string error_caption(const std::string& name, const Grid<glm::vec3>& picture,
                          const Grid<glm::vec3>& truth) {
  if (picture.empty() || truth.empty()) return name;
  const PictureError error = picture_error(picture, truth);
  return fmt::format("{}: mean {:+.1f} %, rms {}", name, 100 * error.bias, percent(error.rms));
}

// Returns ρ/(1−ρτ) of the notes, τ from 0 to 1 from left to right, of the mean albedo: over its largest
// channel, the colour alone; and times 1−τ, what is left of it where no light is lost.
std::pair<Grid<glm::vec3>, Grid<glm::vec3>> saturation_bands(const ShadedScene& scene) {
  constexpr int kWidth = 3 * kPanelSide, kBandHeight = 48;
  Grid<glm::vec3> hue(kWidth, kBandHeight), light(kWidth, kBandHeight);
  const size_t texels = static_cast<size_t>(scene.bake.width) * static_cast<size_t>(scene.bake.height);
  glm::dvec3 albedo(0);
  for (size_t i = 0; i < texels; ++i) albedo += glm::dvec3(scene.albedo.at(i));
  albedo /= static_cast<double>(texels);
  for (int x = 0; x < kWidth; ++x) {
    const double tau = (x + 0.5) / kWidth;
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) color[c] = albedo[c] / (1 - albedo[c] * tau);
    const double largest = std::max({color.x, color.y, color.z, 1e-30});
    for (int y = 0; y < kBandHeight; ++y) {
      hue(x, y) = glm::vec3(color / largest);
      light(x, y) = glm::vec3((1 - tau) * color);
    }
  }
  return {hue, light};
}

// Sets the light of an image, or why there is none.
// missing: the plane that the light needs and the bake lacks, or nothing.
void light_image(const ShadedScene& scene, const std::string& missing,
                 const std::function<Grid<glm::vec3>()>& shade, SceneImage& image) {
  if (!missing.empty())
    image.missing = "the bake holds no " + (missing == "bounce"   ? "bounce map"
                                            : missing == "normal" ? "normals"
                                                                  : missing);
  else if (scene.sky.empty())
    image.missing = "the light of this sky needs normals, and the bake holds none";
  else
    image.light = shade();
}

void light_by_model(const ShadedScene& scene, const AnyModel& model, SceneImage& image) {
  light_image(
      scene, missing_plane(model, scene.bake), [&] { return shade_model(scene, model); }, image);
}

}  // namespace

SceneImages make_scene_images(const ShadedScene& scene, const PictureOptions& options) {
  const Bake& bake = scene.bake;
  SceneImages shaded{{"ao_only", "AO only (alpha)", {}, ""},
                     {"visibility_only", "AO only (V)", {}, ""},
                     {"model", "model", {}, ""},
                     {"bounce_map", "bounce map", {}, ""},
                     {}};
  light_image(
      scene, bake.visible_fraction.empty() ? "ao" : "", [&] { return shade_ao_only(scene); }, shaded.ao_only);
  light_image(
      scene, has_visibility(bake) ? "" : "visibility", [&] { return shade_visibility_only(scene); },
      shaded.visibility_only);
  if (scene.model) {
    shaded.model.caption = "model (" + scene.model->name + ")";
    light_by_model(scene, scene.model->model, shaded.model);
  } else {
    shaded.model.missing = "no model could be fitted";
  }
  if (!scene.model || !std::holds_alternative<BounceMapModel>(scene.model->model))
    light_by_model(scene, BounceMapModel{bake.bounce_albedo}, shaded.bounce_map);
  if (scene.truth) shaded.truth = shade_truth(scene);

  std::vector<const Grid<glm::vec3>*> pictures{&shaded.truth};
  for (const SceneImage* image : shaded.approximations()) pictures.push_back(&image->light);
  shaded.exposure_ev = options.exposure_ev ? *options.exposure_ev : exposure_for(pictures);
  return shaded;
}

void add_triptych(const SceneImages& shaded, Gallery& gallery) {
  std::vector<Panel> row;
  const auto add = [&](const std::string& name, const Grid<glm::vec3>& picture, const std::string& caption) {
    gallery.add_light(name, picture, shaded.exposure_ev);
    row.push_back(light_panel(picture, kPanelSide, shaded.exposure_ev,
                              fmt::format("{}, {:+.2f} EV", caption, shaded.exposure_ev)));
  };
  for (const SceneImage* image : shaded.approximations()) {
    if (!image->missing.empty()) gallery.report_missing(image->name, image->missing);
    if (!image->light.empty()) add(image->name, image->light, image->caption);
  }
  if (shaded.truth.empty())
    gallery.report_missing("truth", "the bake holds no irradiance");
  else
    add("truth", shaded.truth, "ground truth");
  if (!row.empty()) gallery.add_figure("triptych", {&row, 1});
}

void add_differences(const SceneImages& shaded, Gallery& gallery) {
  if (shaded.truth.empty()) return gallery.report_missing("differences", "there is no ground truth");
  std::vector<const SceneImage*> images;
  std::vector<Grid<float>> shown;
  for (const SceneImage* image : shaded.approximations()) {
    if (image->light.empty()) continue;
    images.push_back(image);
    shown.push_back(luminance_of(difference(image->light, shaded.truth)));
  }
  if (images.empty()) return gallery.report_missing("differences", "there is nothing but the ground truth");

  const ColorScale scale = difference_scale(shown);
  std::vector<Panel> row;
  for (size_t k = 0; k < images.size(); ++k) {
    gallery.add_numbers("difference_" + images[k]->name, difference(images[k]->light, shaded.truth), shown[k],
                        scale);
    size_t clipped_shown = 0;
    row.push_back({colored(scaled(shown[k], kPanelSide), scale, clipped_shown),
                   error_caption(images[k]->caption, images[k]->light, shaded.truth)});
  }
  const Grid<glm::vec3> bar = scale_bar(scale, 2 * kPanelSide);
  gallery.add_figure("differences", {&row, 1}, {&bar, 1});
}

void add_bounces(const ShadedScene& scene, const PictureOptions& options, Gallery& gallery) {
  if (!scene.truth) return gallery.report_missing("bounces", "the bake holds no irradiance");
  std::vector<Panel> row;
  const size_t count = std::min(scene.truth->bounces.size(), static_cast<size_t>(options.strip_bounces));
  for (size_t b = 0; b < count; ++b) {
    const Grid<glm::vec3> light = shade_bounce(scene, b);
    const std::array pictures = {&light};
    const double exposure_ev = exposure_for(pictures);
    gallery.add_light(fmt::format("bounce_{:02}", b), light, exposure_ev);
    row.push_back(light_panel(
        light, kStripSide, exposure_ev,
        fmt::format("{}, {:+.2f} EV", b == 0 ? "direct" : fmt::format("bounce {}", b), exposure_ev)));
  }
  if (count == 1) gallery.report_missing("bounces after the first", "the bake holds none");
  gallery.add_figure("bounces", {&row, 1});
}

void add_saturation(const ShadedScene& scene, const SceneImages& shaded, Gallery& gallery) {
  if (shaded.model.light.empty()) return gallery.report_missing("saturation", shaded.model.missing);
  const AnyModel& model = scene.model->model;
  if (!split_bounces(model, {}))
    return gallery.report_missing("saturation", "this model does not tell bounces apart");
  const auto panel = [&](const std::function<double(const TexelInputs&, double)>& factor,
                         const char* caption) {
    return light_panel(shade_with(scene, factor), kPanelSide, shaded.exposure_ev, caption);
  };
  const auto direct = [&](const TexelInputs& at, double) { return split_bounces(model, at)->direct; };
  const auto one_bounce = [&](const TexelInputs& at, double albedo) {
    const BounceSplit split = *split_bounces(model, at);
    return split.direct + albedo * (1 - split.direct) * split.escape;
  };
  const auto [hue, light] = saturation_bands(scene);
  const std::array<std::vector<Panel>, 3> rows = {
      std::vector{light_panel(hue, hue.width, 0,
                              "colour of reflected light as tau goes from 0 to 1: rho / (1 - rho tau)")},
      std::vector{light_panel(light, light.width, 0,
                              "what is left of it where no light is lost: rho (1 - tau) / (1 - rho tau)")},
      std::vector{panel(direct, "model, direct light only"), panel(one_bounce, "model, one bounce"),
                  light_panel(shaded.model.light, kPanelSide, shaded.exposure_ev, "model, all bounces")}};
  gallery.add_figure("saturation", rows);

  Grid<float> tau(scene.bake.width, scene.bake.height);
  for (size_t i = 0; i < tau.size(); ++i)
    tau[i] = static_cast<float>(1 - split_bounces(model, texel_inputs(scene.bake, i))->escape);
  gallery.add_numbers(
      "tau", tau, {sequential_color, 0, 1, 0, "tau: each further bounce over the one before, at albedo 1"});
}

void add_views(const ShadedScene& scene, const SceneImages& shaded, const PictureOptions& options,
               Gallery& gallery) {
  if (!scene.surface)
    return gallery.report_missing("views", "the map of the bake was not found, or is another now");
  const View view = trace_view(*scene.surface, options.camera);
  const auto seen = [&](const Grid<glm::vec3>& picture) {
    return paint_view(*scene.surface, view, picture, glm::vec3(0));
  };
  std::array<std::vector<Panel>, 2> rows;
  const auto add = [&](const char* name, const Grid<glm::vec3>& picture, const std::string& caption) {
    if (picture.empty()) return;
    const Grid<glm::vec3> view_of = seen(picture);
    gallery.add_light(name, view_of, shaded.exposure_ev);
    rows[0].push_back(light_panel(view_of, kPanelSide, shaded.exposure_ev, caption));
  };
  for (const auto& [name, caption, image] :
       {std::tuple{"view_ao_only", "AO only", &shaded.ao_only}, {"view_model", "model", &shaded.model}})
    add(name, image->light, error_caption(caption, image->light, shaded.truth));
  add("view_truth", shaded.truth, "ground truth");
  if (rows[0].size() < 3)
    return gallery.report_missing("overview", "not all of AO only, model and truth are there");

  const std::array errors = {luminance_of(seen(difference(shaded.ao_only.light, shaded.truth))),
                             luminance_of(seen(difference(shaded.model.light, shaded.truth)))};
  const ColorScale scale = difference_scale(errors);
  size_t clipped_shown = 0;
  const Grid<glm::vec3> reflected = seen(difference(shaded.truth, shade_bounce(scene, 0)));
  rows[1] = {{colored(scaled(errors[0], kPanelSide), scale, clipped_shown), "error of AO only"},
             {colored(scaled(errors[1], kPanelSide), scale, clipped_shown), "error of the model"},
             light_panel(reflected, kPanelSide, shaded.exposure_ev, "ground truth, bounces alone")};
  const Grid<glm::vec3> bar = scale_bar(scale, 2 * kPanelSide);
  gallery.add_figure("overview", rows, {&bar, 1});
}

}  // namespace hemibake
