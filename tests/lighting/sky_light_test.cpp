// Light of skies and suns on surfaces: against closed forms, and harmonics against the sky they stand for.
#include "lighting/sky_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "analytic/spherical_pit.h"
#include "core/constants.h"
#include "lighting/sky.h"
#include "support/maps.h"
#include "tracers/ray_options.h"

namespace hemibake {
namespace {

Surface flat_surface() { return make_surface(Grid<float>(4, 4), 1, 0, Edge::kWrap); }

// A bright side and a bright zenith, with light in every band: no nine coefficients hold it.
glm::dvec3 smooth_radiance(const glm::dvec3& d) {
  const glm::dvec3 bright = glm::normalize(glm::dvec3(0.5, 0.3, 0.8));
  return {std::exp(glm::dot(d, bright)), 1 + 0.5 * d.z, 0.5 + 0.4 * std::sin(2 * d.x + d.y)};
}

Grid<glm::vec3> smooth_map() {
  Grid<glm::vec3> map(128, 64);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x)
      map(x, y) = glm::vec3(smooth_radiance(
          direction_of(2 * kPi * (x + 0.5) / map.width, kPi / 2 - kPi * (y + 0.5) / map.height)));
  return map;
}

glm::dvec3 mean_of(const std::vector<glm::dvec3>& light) {
  glm::dvec3 sum(0);
  for (const glm::dvec3& value : light) sum += value;
  return sum / static_cast<double>(light.size());
}

// L = 1 + z over flat ground: ∫ (1 + cosθ) cosθ dω = π + 2π/3.
TEST(SkyLight, FlatGround) {
  const Surface surface = flat_surface();
  const std::vector<float> open(surface.texel_count(), 1.0f),
      open_patches(make_patches(surface, PatchKind::kFacets).count, 1.0f);
  const Radiance radiance = [](const glm::dvec3& d) { return glm::dvec3(1 + d.z); };
  const SkyLightOptions options{1024, 0, glm::dvec3(1)};
  // Stratified in cosθ²: the error of a monotonic integrand is below its range over the number of rays.
  for (const glm::dvec3& e : sky_light_of_texels(surface, open, radiance, options))
    EXPECT_NEAR(e.y, kPi + 2 * kPi / 3, kPi / 1024);
  for (const glm::dvec3& e : sky_light_of_patches(surface, make_patches(surface, PatchKind::kFacets),
                                                  open_patches, radiance, options))
    EXPECT_NEAR(e.y, kPi + 2 * kPi / 3,
                kPi / rays_per_node(1024, kCoarseSubdivision, node_at(kCoarseSubdivision, 1, 0)));
}

// A sky that is the mean everywhere takes the tracer's own E₀, whatever the rays meet.
TEST(SkyLight, UniformSkyIsExact) {
  const Surface surface = white_noise_surface(8, 8, 0.3);
  std::vector<float> direct(surface.texel_count());
  for (size_t i = 0; i < direct.size(); ++i) direct[i] = static_cast<float>(i) / 64;
  const auto light = sky_light_of_texels(surface, direct, [](const glm::dvec3&) { return glm::dvec3(2); },
                                         {4, 0, glm::dvec3(2)});
  for (size_t i = 0; i < direct.size(); ++i)
    EXPECT_EQ(light[i].x, kPi * (2.0 * static_cast<double>(direct[i])));
}

// The bottom of the pit sees its rim at an elevation of T/2, so a cone of half-angle π/2 − T/2: ∫ (1 + cosθ)
// cosθ dω over it.
TEST(SkyLight, BottomOfThePit) {
  const double angle = kPi / 3;
  const SphericalPit pit = make_spherical_pit(64, angle);
  const std::vector<float> unknown(pit.surface.texel_count(), 0.0f);
  const auto light =
      sky_light_of_texels(pit.surface, unknown, [](const glm::dvec3& d) { return glm::dvec3(1 + d.z); },
                          {1024, 0, glm::dvec3(0)});
  const double edge = std::sin(angle / 2);
  const double expected = kPi * (1 - edge * edge) + 2 * kPi / 3 * (1 - std::pow(edge, 3));
  // A jagged rim: half a texel of 29, once round, moves what is seen by that share at most.
  const double jags = expected * 0.5 / 29;
  EXPECT_NEAR(light[pit.surface.heights_m.index(32, 32)].x, expected, jags + 2 * kPi / std::pow(1024, 0.75));
}

// The bar: a smooth sky and its nine coefficients light flat ground and the pit the same to 1 %.
TEST(SkyLight, HarmonicsOfASmoothSky) {
  Sky traced, projected;
  traced.lat_long = smooth_map();
  projected.harmonics = project_to_harmonics(traced.lat_long);
  const Radiance of_map = [&](const glm::dvec3& d) { return traced.radiance(d); };
  const Radiance of_harmonics = [&](const glm::dvec3& d) { return projected.radiance(d); };
  const SkyLightOptions options{1024, 0, projected.mean_radiance()};

  const Surface flat = flat_surface();
  const std::vector<float> open(flat.texel_count(), 1.0f);
  const glm::dvec3 direct = mean_of(sky_light_of_texels(flat, open, of_map, options));
  const glm::dvec3 formula = harmonic_irradiance(projected.harmonics, {0, 0, 1});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(formula[c] / direct[c], 1, 0.01) << "flat ground, channel " << c;

  // The same rays for both: what differs is the sky.
  const SphericalPit pit = make_spherical_pit(32, kPi / 3);
  const std::vector<float> share(pit.surface.texel_count(), static_cast<float>(pit.escape_share));
  const auto a = sky_light_of_texels(pit.surface, share, of_map, options);
  const auto b = sky_light_of_texels(pit.surface, share, of_harmonics, options);
  glm::dvec3 worst(0), sum_a(0), sum_b(0);
  for (const uint32_t texel : pit.texels) {
    worst = glm::max(worst, glm::abs(b[texel] / a[texel] - 1.0));
    sum_a += a[texel];
    sum_b += b[texel];
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(sum_b[c] / sum_a[c], 1, 0.01) << "pit, channel " << c;
    RecordProperty("worst_texel_of_pit_channel_" + std::to_string(c), std::to_string(worst[c]));
  }
}

// The shadow of a wall of height 0.25 behind it ends where the sun's slope does.
TEST(SunShare, ShadowOfAWall) {
  Grid<float> heights(32, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 4; ++x) heights(x, y) = 0.25f;
  const Surface surface = make_surface(heights, 32, 16, Edge::kWrap);  // texels of 1 m, a wall of 4 m
  const double elevation = std::atan(0.5);                             // a shadow of 8 texels
  const auto share = sun_share_of_texels(surface, direction_of(1.5 * kPi, elevation));
  // The wall stands from x = 0 to 3 and comes down to 4: seen from there the sun is over 3 until x = 11.
  for (int x = 6; x <= 10; ++x) EXPECT_EQ(share[surface.heights_m.index(x, 4)], 0) << x;
  for (int x = 12; x <= 29; ++x)
    EXPECT_NEAR(share[surface.heights_m.index(x, 4)], std::sin(elevation), 1e-6) << x;
  EXPECT_NEAR(share[surface.heights_m.index(2, 4)], std::sin(elevation), 1e-6) << "on top";
}

TEST(SunShare, FlatGround) {
  const Surface surface = flat_surface();
  for (const double share : sun_share_of_texels(surface, direction_of(1, 0.3)))
    EXPECT_NEAR(share, std::sin(0.3), 1e-7);
  for (const double share :
       sun_share_of_patches(surface, make_patches(surface, PatchKind::kFacets), direction_of(1, 0.3)))
    EXPECT_NEAR(share, std::sin(0.3), 1e-12);
}

}  // namespace
}  // namespace hemibake
