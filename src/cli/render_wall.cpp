#include "cli/render_wall.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/bake_surface.h"
#include "cli/name_file.h"
#include "cli/retrace.h"
#include "core/color.h"
#include "core/constants.h"
#include "core/error.h"
#include "core/interrupt.h"
#include "curves/curves.h"
#include "fitting/fitted_model.h"
#include "fitting/models.h"
#include "io/fit_file.h"
#include "io/image_io.h"
#include "io/table_io.h"
#include "lighting/sky_light.h"

namespace hemibake {
namespace {

constexpr int kBins = 100;

Albedo read_albedo(const RenderOptions& options, const Bake& bake) {
  if (const auto constant = albedo_from_text(options.albedo)) return {*constant, {}};
  ColorImage image = read_color_image(options.albedo);
  Grid<glm::vec3>& map = image.colors;
  if (map.width != bake.width || map.height != bake.height)
    throw InputError(fmt::format("{}: is {} x {} texels, expected {} x {} as the bake is", options.albedo,
                                 map.width, map.height, bake.width, bake.height));
  const bool srgb =
      options.albedo_encoding == "srgb" || (options.albedo_encoding == "auto" && image.stored_as_integers);
  for (size_t i = 0; i < map.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (!(map[i][c] >= 0 && map[i][c] <= 1))
        throw InputError(fmt::format("{}: reflectance {} at texel {},{}, expected 0..1", options.albedo,
                                     map[i][c], i % static_cast<size_t>(map.width),
                                     i / static_cast<size_t>(map.width)));
      if (srgb) map[i][c] = static_cast<float>(linear_from_srgb(static_cast<double>(map[i][c])));
    }
  return {glm::vec3(0), std::move(map)};
}

Sky read_sky(const RenderOptions& options) {
  if (options.sky_file().empty()) return make_uniform_sky();
  const std::filesystem::path path = options.sky_file();
  Sky sky;
  if (options.sky_is_harmonics()) {
    const std::vector<double> numbers = read_numbers(path, 3 * kHarmonics);
    for (size_t i = 0; i < kHarmonics; ++i)
      sky.harmonics[i] = {numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]};
    return sky;
  }
  sky.lat_long = read_color_image(path).colors;
  for (size_t i = 0; i < sky.lat_long.size(); ++i) {
    const glm::vec3& value = sky.lat_long[i];
    if (std::min({value.x, value.y, value.z}) < 0)
      throw InputError(fmt::format("{}: negative radiance at pixel {},{}, expected 0 or more", path.string(),
                                   i % static_cast<size_t>(sky.lat_long.width),
                                   i / static_cast<size_t>(sky.lat_long.width)));
  }
  sky.harmonics = project_to_harmonics(sky.lat_long);
  if (options.sky_truth == "sh") sky.lat_long = {};
  return sky;
}

template <class Model>
ShadingModel shading_model(std::string name, const Model& model) {
  return {std::move(name), [model](double ao, double albedo) { return model.total(ao, albedo); },
          [model](double ao) { return model.direct(ao); },
          [model](double ao) { return model.first_bounce(ao); },
          [model](double ao) { return model.bounce_ratio(ao); }};
}

// Of --fit, or of the bake's own curves; none where these do not suffice for a fit, which `reason` then says.
std::optional<ShadingModel> find_model(const RenderOptions& options, const Bake& bake, std::string& reason) {
  FitFile fits;
  std::filesystem::path path = options.fit;
  if (!path.empty()) {
    fits = read_fits(path);
  } else {
    path = options.bake;
    try {
      fits.fits = fit_model(options.model, make_curves(bake, kBins), Abscissa::kCenter, Weights::kNone);
    } catch (const std::runtime_error& error) {
      throw_if_interrupted();
      reason = error.what();
      return std::nullopt;
    }
  }
  const ShaderModel model = with_file_context(
      path, [&] { return fitted_model(fits.fits, model_kind_from_string(options.model)); });
  return std::visit([&](const auto& m) { return shading_model(options.model, m); }, model);
}

Grid<glm::vec3> unshaded_sky(const Sky& sky, const Bake& bake, const std::optional<Surface>& surface) {
  const Grid<glm::vec3>& normals = bake.normals.empty() && surface ? surface->normals : bake.normals;
  if (sky.uniform) return Grid<glm::vec3>(bake.width, bake.height, glm::vec3(static_cast<float>(kPi)));
  Grid<glm::vec3> irradiance(normals.width, normals.height);
  for (size_t i = 0; i < irradiance.size(); ++i)
    irradiance[i] = glm::vec3(harmonic_irradiance(sky.harmonics, glm::dvec3(normals[i])));
  return irradiance;
}

std::vector<glm::dvec3> uniform_light(std::span<const float> direct_over_pi) {
  std::vector<glm::dvec3> light;
  for (const float direct : direct_over_pi) light.emplace_back(kPi * static_cast<double>(direct));
  return light;
}

void add_sun(const std::vector<double>& share, double irradiance, std::vector<glm::dvec3>& light) {
  for (size_t i = 0; i < light.size(); ++i) light[i] += glm::dvec3(irradiance * share[i]);
}

// The sky before any bounce, at every texel and every patch.
ColoredLight sky_light(const RenderOptions& options, const Sky& sky, const Surface& surface,
                       const PatchSet& patches, const LightTransport& seen) {
  if (sky.uniform) return {uniform_light(seen.direct_over_pi.values), uniform_light(seen.patch_direct())};
  const SkyLightOptions rays{options.sky_rays, 0, sky.mean_radiance()};
  const Radiance radiance = [&](const glm::dvec3& d) { return sky.radiance(d); };
  ColoredLight light;
  light.texel_light = sky_light_of_texels(surface, seen.direct_over_pi.values, radiance, rays);
  light.patch_light = seen.patch_form_factors.empty()
                          ? light.texel_light
                          : sky_light_of_patches(surface, patches, seen.patch_direct(), radiance, rays);
  return light;
}

Grid<glm::vec3> as_grid(const std::vector<glm::dvec3>& light, const Surface& surface) {
  Grid<glm::vec3> grid(surface.width(), surface.height());
  std::ranges::transform(light, grid.values.begin(), [](const glm::dvec3& e) { return glm::vec3(e); });
  return grid;
}

// What nine coefficients of the sky are off by where the surface hides parts of it: E₀ of the texels under
// the projection against that under the sky itself.
PictureError error_of_projection(const Sky& sky, const Surface& surface, const LightTransport& seen, int rays,
                                 const std::vector<glm::dvec3>& traced) {
  const auto projected =
      sky_light_of_texels(surface, seen.direct_over_pi.values,
                          [&](const glm::dvec3& d) { return harmonic_radiance(sky.harmonics, d); },
                          {rays, 0, sky.mean_radiance()});
  return picture_error(as_grid(projected, surface), as_grid(traced, surface));
}

// Sends sky and sun round over the links of the bake.
void relight(const RenderOptions& options, const BakeFile& file, const BakeOptions& tracing, const Sky& sky,
             const std::optional<Sun>& sun, RenderedScene& result) {
  ShadedScene& wall = result.wall;
  const Surface& surface = *wall.surface;
  const LightTransport seen =
      options.links.empty() ? retrace(tracing) : visibility_from_links(options.links, file);
  const bool on_facets = !seen.patch_form_factors.empty();
  const PatchSet patches = make_patches(surface, on_facets ? PatchKind::kFacets : PatchKind::kTexels);
  if (seen.final_gather.columns != patches.count)
    throw InputError(fmt::format("{}: has {} patches, expected {} as this version makes of the map",
                                 options.links.string(), seen.final_gather.columns, patches.count));
  ColoredLight light = sky_light(options, sky, surface, patches, seen);
  if (!sky.lat_long.empty())
    result.light["sky_projected_against_traced"] =
        json_from_error(error_of_projection(sky, surface, seen, options.sky_rays, light.texel_light));
  if (sun) {
    const std::vector<double> share = sun_share_of_texels(surface, sun->direction);
    std::vector<glm::dvec3> irradiance(share.size());
    add_sun(share, sun->irradiance, irradiance);
    wall.sun = as_grid(irradiance, surface);
    add_sun(share, sun->irradiance, light.texel_light);
    add_sun(on_facets ? sun_share_of_patches(surface, patches, sun->direction) : share, sun->irradiance,
            light.patch_light);
  }
  const size_t stored = file.bake.irradiance.size();
  wall.truth = relight_over_links(seen, light, albedo_of_patches(surface, wall.albedo, patches),
                                  stored > 1 ? static_cast<int>(stored) - 1 : BakeOptions().bounces,
                                  sky.uniform && !sun ? std::optional(kPi) : std::nullopt);
}

}  // namespace

nlohmann::ordered_json json_from_error(const PictureError& error) {
  return {{"bias_over_mean", error.bias}, {"rms_over_mean", error.rms}, {"largest_over_mean", error.largest}};
}

RenderedScene shade_scene(const RenderOptions& options, BakeFile file) {
  RenderedScene result;
  ShadedScene& wall = result.wall;
  nlohmann::ordered_json& light = result.light;
  const Bake& bake = file.bake;
  wall.albedo = read_albedo(options, bake);
  const Sky sky = read_sky(options);
  const std::optional<Sun> sun = sun_from_text(options.sun);
  const bool runs_again = !wall.albedo.map.empty() || !sky.uniform || sun;

  BakeOptions tracing;
  try {
    tracing = tracing_options_from(file, options.bake);
    wall.surface = load_bake_map(tracing).surface;
    if (wall.surface->width() != bake.width || wall.surface->height() != bake.height)
      throw InputError(options.bake.string() + ": its map has another size, expected the bake's");
  } catch (const InputError& error) {
    if (runs_again) throw;
    wall.surface.reset();
    light["map"] = error.what();
  }

  wall.sky = unshaded_sky(sky, bake, wall.surface);
  std::string no_model;
  wall.model = find_model(options, bake, no_model);
  if (!no_model.empty()) light["model"] = no_model;

  if (runs_again) {
    relight(options, file, tracing, sky, sun, result);
  } else if (!bake.irradiance.empty()) {
    wall.truth = relight_constant(bake.irradiance, wall.albedo.constant);
  }
  if (wall.truth) {
    light["bounces"] = wall.truth->bounces.size() - 1;
    light["rest_of_series_mean_over_pi"] = wall.truth->mean_rest / kPi;
    light["rest_of_series_largest_over_pi"] = wall.truth->largest_rest / kPi;
  }
  wall.bake = std::move(file.bake);
  return result;
}

}  // namespace hemibake
