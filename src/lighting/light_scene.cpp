#include "lighting/light_scene.h"

#include <algorithm>
#include <limits>
#include <span>
#include <vector>

#include "core/constants.h"
#include "lighting/sky_light.h"

namespace hemibake {
namespace {

std::vector<glm::dvec3> uniform_light(std::span<const float> direct_over_pi) {
  std::vector<glm::dvec3> light;
  for (const float direct : direct_over_pi) light.emplace_back(kPi * static_cast<double>(direct));
  return light;
}

void add_sun(const std::vector<double>& share, double irradiance, std::vector<glm::dvec3>& light) {
  for (size_t i = 0; i < light.size(); ++i) light[i] += glm::dvec3(irradiance * share[i]);
}

Grid<glm::vec3> as_grid(const std::vector<glm::dvec3>& light, const Surface& surface) {
  Grid<glm::vec3> grid(surface.width(), surface.height());
  std::ranges::transform(light, grid.values.begin(), [](const glm::dvec3& e) { return glm::vec3(e); });
  return grid;
}

// Returns the light of the sky before any bounce.
ColoredLight direct_sky(const SceneLight& light, const Surface& surface, const PatchSet& patches,
                        const LightTransport& transport) {
  const Sky& sky = light.sky;
  if (sky.uniform)
    return {uniform_light(transport.direct_over_pi.values), uniform_light(transport.patch_direct())};
  const SkyLightOptions rays{light.sky_rays, 0, sky.mean_radiance()};
  const Radiance radiance = [&](const glm::dvec3& d) { return sky.radiance(d); };
  ColoredLight direct;
  direct.texel_light = sky_light_of_texels(surface, transport.direct_over_pi.values, radiance, rays);
  direct.patch_light = patches.kind == PatchKind::kTexels
                           ? direct.texel_light
                           : sky_light_of_patches(surface, patches, transport.patch_direct(), radiance, rays);
  return direct;
}

// Compares E₀ of the texels under the sky's nine coefficients with `traced`, that under the sky itself.
PictureError error_of_projection(const SceneLight& light, const Surface& surface,
                                 const LightTransport& transport, const std::vector<glm::dvec3>& traced) {
  const auto projected =
      sky_light_of_texels(surface, transport.direct_over_pi.values,
                          [&](const glm::dvec3& d) { return harmonic_radiance(light.sky.harmonics, d); },
                          {light.sky_rays, 0, light.sky.mean_radiance()});
  return picture_error(as_grid(projected, surface), as_grid(traced, surface));
}

}  // namespace

bool needs_transport(const SceneLight& light, const Albedo& albedo) {
  return !albedo.map.empty() || !light.sky.uniform || light.sun;
}

Grid<glm::vec3> unshaded_sky(const Sky& sky, const Grid<glm::vec3>& normals, int width, int height) {
  if (sky.uniform) return Grid<glm::vec3>(width, height, glm::vec3(static_cast<float>(kPi)));
  Grid<glm::vec3> irradiance(normals.width, normals.height);
  for (size_t i = 0; i < irradiance.size(); ++i)
    irradiance[i] = glm::vec3(harmonic_irradiance(sky.harmonics, glm::dvec3(normals[i])));
  return irradiance;
}

PatchSet patches_of_transport(const Surface& surface, const LightTransport& transport) {
  return make_patches(surface,
                      transport.patch_form_factors.empty() ? PatchKind::kTexels : PatchKind::kFacets);
}

LitScene light_scene(const Surface& surface, const LightTransport& transport, const Albedo& albedo,
                     const SceneLight& light, int bounces) {
  const PatchSet patches = patches_of_transport(surface, transport);
  LitScene lit;
  ColoredLight direct = direct_sky(light, surface, patches, transport);
  if (!light.sky.lat_long.empty())
    lit.projection_error = error_of_projection(light, surface, transport, direct.texel_light);
  if (light.sun) {
    const Sun& sun = *light.sun;
    const std::vector<double> share = sun_share_of_texels(surface, sun.direction);
    std::vector<glm::dvec3> irradiance(share.size());
    add_sun(share, sun.irradiance, irradiance);
    lit.sun = as_grid(irradiance, surface);
    add_sun(share, sun.irradiance, direct.texel_light);
    add_sun(
        patches.kind == PatchKind::kTexels ? share : sun_share_of_patches(surface, patches, sun.direction),
        sun.irradiance, direct.patch_light);
  }
  // Light is neither made nor lost: under a sky of radiance 1 no texel receives more than π.
  const double most = light.sky.uniform && !light.sun ? kPi : std::numeric_limits<double>::infinity();
  lit.relit =
      relight_by_transport(transport, direct, albedo_of_patches(surface, albedo, patches), bounces, most);
  return lit;
}

}  // namespace hemibake
