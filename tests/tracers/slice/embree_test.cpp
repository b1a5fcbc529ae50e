// The slice tracer against Embree on the same triangles.
#include "tracers/embree/embree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/statistics.h"
#include "sampling/low_discrepancy.h"
#include "support/maps.h"
#include "surface/normals.h"
#include "tracers/slice/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

constexpr int kRays = 1024;
// Slices so many that Embree's error is the larger one by far.
constexpr int kAzimuths = 256;

// Returns the lift of Embree's starts; without it Embree sees 2·10⁻⁴ more sky on a rough map.
double lift_of_embree(const Surface& surface) {
  const double range = height_range_m(surface) / surface.texel_size_m;
  return std::max(1e-3 * std::min(1.0, range), 0x1p-21 * range);
}

LightTransport with_embree(const Surface& surface, bool with_links, double max_distance_m,
                           PatchKind patches) {
  RayOptions options;
  options.rays = kRays;
  options.max_distance_m = max_distance_m;
  options.patch_kind = patches;
  return trace_surface(*make_embree_tracer(surface, options),
                       with_links ? KeptLinks::kAll : KeptLinks::kNone);
}

LightTransport with_slices(const Surface& surface, bool with_links, double max_distance_m,
                           PatchKind patches) {
  SliceOptions options;
  options.azimuths = kAzimuths;
  options.lift_texels = lift_of_embree(surface);
  options.max_distance_m = max_distance_m;
  options.patch_kind = patches;
  return trace_surface(*make_slice_tracer(surface, options), with_links ? KeptLinks::kAll : KeptLinks::kNone);
}

// Twice the error of a low-discrepancy set, N^−¾ with a constant of 2 at most (measured rms: 0.45).
const double kTexelError = 4 * std::pow(kRays, -0.75);
// Averaged over 64² texels or more: an rms of 0.45 · N^−¾ / 64 is 4·10⁻⁵.
constexpr double kMeanError = 1e-4;

void expect_same_sky(const Surface& surface, double max_distance_m = HUGE_VAL) {
  const LightTransport rays = with_embree(surface, false, max_distance_m, PatchKind::kFacets);
  const LightTransport slices = with_slices(surface, false, max_distance_m, PatchKind::kFacets);
  EXPECT_NEAR(mean(rays.visible_fraction.values), mean(slices.visible_fraction.values), kMeanError);
  EXPECT_NEAR(mean(rays.direct_over_pi.values), mean(slices.direct_over_pi.values), kMeanError);
  EXPECT_LT(rms_difference(rays.visible_fraction.values, slices.visible_fraction.values), kTexelError / 4);
  EXPECT_LT(rms_difference(rays.direct_over_pi.values, slices.direct_over_pi.values), kTexelError / 4);
  double worst_bent = 0;
  for (size_t i = 0; i < rays.visible_fraction.size(); ++i) {
    EXPECT_NEAR(rays.visible_fraction[i], slices.visible_fraction[i], kTexelError) << i;
    EXPECT_NEAR(rays.direct_over_pi[i], slices.direct_over_pi[i], kTexelError) << i;
    if (rays.visible_fraction[i] > 0.2f)
      worst_bent = std::max(worst_bent,
                            static_cast<double>(glm::distance(rays.bent_normals[i], slices.bent_normals[i])));
  }
  // A direction averaged over at least a fifth of the rays.
  EXPECT_LT(worst_bent, 5 * kTexelError);
}

TEST(SliceAgainstEmbree, RoughMap) {
  expect_same_sky(synthetic_surface(SyntheticKind::kBricks, 64, 64, 0.15));
}
TEST(SliceAgainstEmbree, WhiteNoise) { expect_same_sky(white_noise_surface(64, 64, 0.05)); }
TEST(SliceAgainstEmbree, SmoothMap) {
  expect_same_sky(synthetic_surface(SyntheticKind::kShapes, 96, 96, 0.45));
}
TEST(SliceAgainstEmbree, NarrowMap) {
  expect_same_sky(synthetic_surface(SyntheticKind::kNoise, 300, 20, 0.02));
}
TEST(SliceAgainstEmbree, OpenEdges) {
  expect_same_sky(synthetic_surface(SyntheticKind::kConcrete, 90, 60, 0.2, {}, Edge::kOpen));
}
TEST(SliceAgainstEmbree, GroundEdges) {
  expect_same_sky(synthetic_surface(SyntheticKind::kConcrete, 90, 60, 0.2, {}, Edge::kGround));
  expect_same_sky(synthetic_surface(SyntheticKind::kTerrain, 64, 64, {}, {}, Edge::kGround));
}
TEST(SliceAgainstEmbree, MaxDistance) {
  expect_same_sky(synthetic_surface(SyntheticKind::kShapes, 64, 64, 0.45), 0.15);
  expect_same_sky(synthetic_surface(SyntheticKind::kNoise, 64, 64, 0.3, {}, Edge::kOpen), 0.1);
}

TEST(SliceAgainstEmbree, TiltedNormals) {
  Surface surface = synthetic_surface(SyntheticKind::kNoise, 64, 64, 0.2);
  for (size_t i = 0; i < surface.normals.size(); ++i) {
    const auto random = [&](uint64_t stream) {
      return static_cast<float>(unit_interval(mix_bits(3, stream, i)));
    };
    surface.normals[i] = glm::normalize(glm::vec3(4 * random(0) - 2, 4 * random(1) - 2, 1));
  }
  expect_same_sky(surface);
  expect_same_sky(surface, 0.05);
}

void expect_same_bounces(const Surface& surface, PatchKind patches, double max_distance_m = HUGE_VAL) {
  BounceOptions options;
  options.bounces = 3;
  const Bounces rays = bounce_light(with_embree(surface, true, max_distance_m, patches), options);
  const Bounces slices = bounce_light(with_slices(surface, true, max_distance_m, patches), options);
  for (size_t b = 0; b < rays.irradiance.size(); ++b) {
    // E is π times E/π, and so is its error.
    EXPECT_NEAR(mean(rays.irradiance[b].values), mean(slices.irradiance[b].values), 3e-3) << "bounce " << b;
    EXPECT_LT(rms_difference(rays.irradiance[b].values, slices.irradiance[b].values), 3.2 * kTexelError / 4)
        << b;
  }
}

TEST(SliceAgainstEmbree, LightBouncedBetweenFacets) {
  expect_same_bounces(synthetic_surface(SyntheticKind::kBricks, 48, 48, 0.15), PatchKind::kFacets);
  expect_same_bounces(synthetic_surface(SyntheticKind::kConcrete, 40, 48, 0.3, {}, Edge::kOpen),
                      PatchKind::kFacets);
  expect_same_bounces(synthetic_surface(SyntheticKind::kConcrete, 40, 48, 0.3, {}, Edge::kGround),
                      PatchKind::kFacets);
  expect_same_bounces(synthetic_surface(SyntheticKind::kNoise, 48, 48, 0.3), PatchKind::kFacets, 0.15);
}

TEST(SliceAgainstEmbree, LightBouncedBetweenTexels) {
  expect_same_bounces(synthetic_surface(SyntheticKind::kBricks, 48, 48, 0.15), PatchKind::kTexels);
  expect_same_bounces(synthetic_surface(SyntheticKind::kConcrete, 40, 48, 0.3, {}, Edge::kGround),
                      PatchKind::kTexels);
  expect_same_bounces(synthetic_surface(SyntheticKind::kNoise, 48, 48, 0.3), PatchKind::kTexels, 0.15);
}

}  // namespace
}  // namespace hemibake
