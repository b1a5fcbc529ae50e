#include "cli/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "fitting/fitted_model.h"

namespace hemibake {
namespace {

constexpr double kLargestExposure = 100;  // stops
constexpr double kLargestSun = 1e6;

// The numbers of a list separated by commas; nullopt where one of them is none.
std::optional<std::vector<double>> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const char *at = text.data(), *const end = at + text.size();; ++at) {
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || !std::isfinite(value)) return std::nullopt;
    numbers.push_back(value);
    if (stop == end) return numbers;
    if (*stop != ',') return std::nullopt;
    at = stop;
  }
}

double radians(double degrees) { return degrees * kPi / 180; }

[[noreturn]] void refuse(const char* option, const std::string& text, const char* expected) {
  throw InputError(fmt::format("{}: '{}', expected {}", option, text, expected));
}

}  // namespace

bool RenderOptions::wants(const std::string& subject) const {
  return std::ranges::find(pictures, subject) != pictures.end();
}

std::filesystem::path RenderOptions::sky_file() const { return sky[0] == "uniform" ? "" : sky.back(); }

std::vector<Field> render_fields(RenderOptions& options) {
  const auto grouped = [](const char* group, std::vector<Field> fields) {
    for (Field& field : fields) field.group = group;
    return fields;
  };
  Value sky = texts(options.sky);
  sky.most = 2;
  std::vector<Field> fields = {
      option("BAKE", file(options.bake),
             "the bake; pictures of what it does not hold are left out and named"),
      shown_as(
          required(output_option(options.folder, "folder for the pictures and render.json; made if new")),
          "DIR"),
      option("pictures",
             choices(options.pictures,
                     {"light", "differences", "bounces", "saturation", "planes", "estimators", "views"}),
             "subjects to draw, separated by commas")};
  append(fields,
         grouped(
             "Wall",
             {shown_as(option("albedo", text(options.albedo),
                              "reflectance 0..1: R,G,B, or one number, or an image of the bake's size, "
                              "whose bounces are then run again over the links"),
                       "R,G,B | FILE"),
              option("albedo-encoding", choice(options.albedo_encoding, {"auto", "linear", "srgb"}),
                     "of the image: linear, or srgb; auto: srgb where it stores integers"),
              shown_as(option("links", file(options.links),
                              "links file of the bake; without it the map is traced again where light has "
                              "to go round again (albedo map, sun, any sky but uniform)"),
                       "LINKS.h5"),
              option("model", choice(options.model, model_kind_names()),
                     "the model that shades. From V, the cosine-weighted AO: visibility, jimenez; from V and "
                     "the uniform AO: visibility-ao, visibility-ao-mean; from V and the normal: "
                     "visibility-normal; from the planes visibility and bounce: bounce-map; from "
                     "the uniform AO: bounded, published"),
              option("constants", choice(options.constants, {"fit", "none"}),
                     "of the bake's own curves or of --fit; or those that a model has without fits, as in "
                     "'hemibake export'"),
              shown_as(option("fit", file(options.fit), "constants of the model"), "FIT.json")}));
  append(
      fields,
      grouped("Light",
              {shown_as(option("sky", sky,
                               "uniform: radiance 1; sh FILE: nine RGB coefficients of radiance, L00 L1-1 "
                               "L10 L11 L2-2 L2-1 L20 L21 L22 (Ramamoorthi and Hanrahan 2001) with x right, "
                               "y down the rows, z up; or a latitude-longitude image, top row up, azimuth 0 "
                               "(the top of the map) at its left edge, clockwise"),
                        "uniform | sh FILE | FILE"),
               option("sky-truth", choice(options.sky_truth, {"traced", "sh"}),
                      "what lights the ground truth under an image: the image itself, direction by "
                      "direction, or its projection to sh, which lights the other pictures"),
               option("sky-rays", whole(options.sky_rays, 1, 1 << 20),
                      "rays per texel, and about as many per facet, to a sky that is not uniform"),
               shown_as(option("sun", text(options.sun),
                               "azimuth, degrees clockwise from the top of the map; elevation, degrees over "
                               "0 to 90; irradiance of a surface facing it (a uniform sky gives pi)"),
                        "AZIMUTH,ELEVATION,INTENSITY")}));
  append(
      fields,
      grouped("Pictures",
              {option("exposure", number(options.picture.exposure_ev, -kLargestExposure, kLargestExposure),
                      "stops, of AO only, model, truth and views; default: chosen so that a thousandth of "
                      "the pixels is above white"),
               option("strip", whole(options.picture.strip_bounces, 1, 64), "panels in the strip of bounces"),
               shown_as(option("camera", text(options.camera),
                               "where the camera of the views stands: azimuth as of --sun, elevation 5 to 90 "
                               "degrees"),
                        "AZIMUTH,ELEVATION"),
               option("view-width", whole(options.view_width, 16, 8192), "of the views, pixels")}));
  return fields;
}

void resolve(RenderOptions& options) {
  // `--sky uniform BAKE.exr`: the second word is no file of the sky's.
  if (options.bake.empty() && options.sky.size() == 2 && options.sky[0] != "sh") {
    options.bake = options.sky.back();
    options.sky.pop_back();
  }
  if (options.bake.empty()) throw InputError("BAKE: is missing, expected the file of a bake");
  if (options.sky[0] == "sh" && options.sky.size() != 2)
    throw InputError("--sky: sh by itself, expected a file of coefficients after it");
  if (options.sky[0] != "sh" && options.sky.size() != 1)
    refuse("--sky", options.sky[0] + " " + options.sky[1], "uniform, sh FILE, or one image");

  const auto camera = numbers_of(options.camera);
  if (!camera || camera->size() != 2 || std::abs((*camera)[0]) > 360 || (*camera)[1] < 5 || (*camera)[1] > 90)
    refuse("--camera", options.camera, "AZIMUTH,ELEVATION within -360..360 and 5..90 degrees");
  options.picture.camera.azimuth_rad = radians((*camera)[0]);
  options.picture.camera.elevation_rad = radians((*camera)[1]);
  options.picture.camera.width = options.view_width;
  options.picture.camera.height = std::max(1, options.view_width * 3 / 4);
}

std::optional<glm::vec3> albedo_from_text(const std::string& text) {
  const auto numbers = numbers_of(text);
  if (!numbers) return std::nullopt;
  const bool in_range = std::ranges::all_of(*numbers, [](double v) { return v >= 0 && v <= 1; });
  if (!in_range || (numbers->size() != 1 && numbers->size() != 3))
    refuse("--albedo", text, "one or three numbers in 0..1, or an image");
  const std::vector<double>& n = *numbers;
  return n.size() == 1 ? glm::vec3(static_cast<float>(n[0])) : glm::vec3(glm::dvec3(n[0], n[1], n[2]));
}

std::optional<Sun> sun_from_text(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto n = numbers_of(text);
  if (!n || n->size() != 3 || std::abs((*n)[0]) > 360 || !((*n)[1] > 0 && (*n)[1] <= 90) ||
      !((*n)[2] >= 0 && (*n)[2] <= kLargestSun))
    refuse("--sun", text,
           "AZIMUTH,ELEVATION,INTENSITY within -360..360 degrees, over 0 to 90 degrees and 0..1e6");
  return Sun{direction_of(radians((*n)[0]), radians((*n)[1])), (*n)[2]};
}

}  // namespace hemibake
