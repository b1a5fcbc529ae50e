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

// Returns ± the round number that takes in kScaleShare of both.
ColorScale difference_scale(const Grid<float>& a, const Grid<float>& b, const std::string& label) {
  std::vector<float> sizes;
  for (const Grid<float>* values : {&a, &b})
    for (const float value : values->values) sizes.push_back(std::abs(value));
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(kScaleShare * (sizes.size() - 1));
  std::nth_element(sizes.begin(), place, sizes.end());
  const double most = round_scale(static_cast<double>(*place));
  return {diverging_color, -most, most, -1, label};
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

std::string error_caption(const char* name, const Grid<glm::vec3>& picture, const Grid<glm::vec3>& truth) {
  if (picture.empty() || truth.empty()) return name;
  const PictureError error = picture_error(picture, truth);
  return fmt::format("{}: mean {:+.1f} %, rms {}", name, 100 * error.bias, percent(error.rms));
}

// Returns why a picture cannot be made, or nothing.
std::string why_not(const ShadedScene& scene, bool needs_model) {
  if (scene.bake.visible_fraction.empty()) return "the bake holds no ao";
  if (scene.sky.empty()) return "the light of this sky needs normals, and the bake holds none";
  if (needs_model && !scene.model) return "no model could be fitted";
  return "";
}

struct NamedDifference {
  const char* name;
  const char* caption;
  const Grid<glm::vec3>* picture;
};

}  // namespace

SceneImages make_scene_images(const ShadedScene& scene, const PictureOptions& options) {
  SceneImages shaded;
  if (why_not(scene, false).empty()) shaded.ao_only = shade_ao_only(scene);
  if (why_not(scene, true).empty()) shaded.model = shade_model(scene);
  if (scene.truth) shaded.truth = shade_truth(scene);
  const std::array pictures = {&std::as_const(shaded.ao_only), &std::as_const(shaded.model),
                               &std::as_const(shaded.truth)};
  shaded.exposure_ev = options.exposure_ev ? *options.exposure_ev : exposure_for(pictures);
  return shaded;
}

void add_triptych(const ShadedScene& scene, const SceneImages& shaded, Gallery& gallery) {
  std::vector<Panel> row;
  const auto add = [&](const char* name, const Grid<glm::vec3>& picture, const std::string& caption,
                       const std::string& reason) {
    if (picture.empty()) return gallery.report_missing(name, reason);
    gallery.add_light(name, picture, shaded.exposure_ev);
    row.push_back(light_panel(picture, kPanelSide, shaded.exposure_ev,
                              fmt::format("{}, {:+.2f} EV", caption, shaded.exposure_ev)));
  };
  add("ao_only", shaded.ao_only, "AO only", why_not(scene, false));
  add("model", shaded.model, scene.model ? "model (" + scene.model->name + ")" : "", why_not(scene, true));
  add("truth", shaded.truth, "ground truth", "the bake holds no irradiance");
  if (!row.empty()) gallery.add_figure("triptych", {&row, 1});
}

void add_differences(const SceneImages& shaded, Gallery& gallery) {
  if (shaded.truth.empty()) return gallery.report_missing("differences", "there is no ground truth");
  std::vector<NamedDifference> named;
  if (!shaded.ao_only.empty()) named.push_back({"difference_ao_only", "AO only", &shaded.ao_only});
  if (!shaded.model.empty()) named.push_back({"difference_model", "model", &shaded.model});
  if (named.empty()) return gallery.report_missing("differences", "there is nothing but the ground truth");

  std::vector<Grid<glm::vec3>> differences;
  for (const NamedDifference& one : named) differences.push_back(difference(*one.picture, shaded.truth));
  const ColorScale scale =
      difference_scale(luminance_of(differences.front()), luminance_of(differences.back()), kDifferenceLabel);
  std::vector<Panel> row;
  for (size_t k = 0; k < named.size(); ++k) {
    const Grid<float> shown = luminance_of(differences[k]);
    gallery.add_numbers(named[k].name, differences[k], shown, scale);
    size_t clipped_shown = 0;
    row.push_back({colored(scaled(shown, kPanelSide), scale, clipped_shown),
                   error_caption(named[k].caption, *named[k].picture, shaded.truth)});
  }
  const Grid<glm::vec3> bar = scale_bar(scale, kPanelSide);
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
  if (shaded.model.empty()) return gallery.report_missing("saturation", why_not(scene, true));
  // ρ/(1−ρτ) of the notes, τ from 0 to 1, over its largest channel: the colour alone; and times 1−τ, which is
  // what is left of it where no light is lost.
  const int width = 3 * kPanelSide;
  constexpr int kBandHeight = 48;
  Grid<glm::vec3> hue(width, kBandHeight), light(width, kBandHeight);
  glm::dvec3 albedo(0);
  for (size_t i = 0; i < shaded.model.size(); ++i) albedo += glm::dvec3(scene.albedo.at(i));
  albedo /= static_cast<double>(shaded.model.size());
  for (int x = 0; x < width; ++x) {
    const double tau = (x + 0.5) / width;
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c) color[c] = albedo[c] / (1 - albedo[c] * tau);
    const double largest = std::max({color.x, color.y, color.z, 1e-30});
    for (int y = 0; y < kBandHeight; ++y) {
      hue(x, y) = glm::vec3(color / largest);
      light(x, y) = glm::vec3((1 - tau) * color);
    }
  }
  const ShadingModel& model = *scene.model;
  const auto panel = [&](const std::function<double(double, double)>& factor, const char* caption) {
    return light_panel(shade_with(scene, factor), kPanelSide, shaded.exposure_ev, caption);
  };
  const auto direct = [&](double ao, double) { return model.direct(ao); };
  const auto one_bounce = [&](double ao, double rho) {
    return model.direct(ao) + rho * model.first_bounce(ao);
  };
  const std::array<std::vector<Panel>, 3> rows = {
      std::vector{light_panel(hue, width, 0,
                              "colour of reflected light as tau goes from 0 to 1: rho / (1 - rho tau)")},
      std::vector{light_panel(light, width, 0,
                              "what is left of it where no light is lost: rho (1 - tau) / (1 - rho tau)")},
      std::vector{panel(direct, "model, direct light only"), panel(one_bounce, "model, one bounce"),
                  panel(model.total, "model, all bounces")}};
  gallery.add_figure("saturation", rows);

  Grid<float> tau(scene.bake.width, scene.bake.height);
  for (size_t i = 0; i < tau.size(); ++i)
    tau[i] = static_cast<float>(model.bounce_ratio(static_cast<double>(scene.bake.visible_fraction[i])));
  gallery.add_numbers(
      "tau", tau, {sequential_color, 0, 1, 0, "tau: each further bounce over the one before, at albedo 1"});
}

void add_views(const ShadedScene& scene, const SceneImages& shaded, const PictureOptions& options,
               Gallery& gallery) {
  if (!scene.surface) return gallery.report_missing("views", "the map of the bake was not found");
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
  add("view_ao_only", shaded.ao_only, error_caption("AO only", shaded.ao_only, shaded.truth));
  add("view_model", shaded.model, error_caption("model", shaded.model, shaded.truth));
  add("view_truth", shaded.truth, "ground truth");
  if (rows[0].size() < 3)
    return gallery.report_missing("overview", "not all of AO only, model and truth are there");

  const Grid<float> of_ao = luminance_of(seen(difference(shaded.ao_only, shaded.truth)));
  const Grid<float> of_model = luminance_of(seen(difference(shaded.model, shaded.truth)));
  const ColorScale scale = difference_scale(of_ao, of_model, kDifferenceLabel);
  size_t clipped_shown = 0;
  const Grid<glm::vec3> reflected = seen(difference(shaded.truth, shade_bounce(scene, 0)));
  rows[1] = {{colored(scaled(of_ao, kPanelSide), scale, clipped_shown), "error of AO only"},
             {colored(scaled(of_model, kPanelSide), scale, clipped_shown), "error of the model"},
             light_panel(reflected, kPanelSide, shaded.exposure_ev, "ground truth, bounces alone")};
  const Grid<glm::vec3> bar = scale_bar(scale, 2 * kPanelSide);
  gallery.add_figure("overview", rows, {&bar, 1});
}

}  // namespace hemibake
