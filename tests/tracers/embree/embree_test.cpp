#include "tracers/embree/embree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/maps.h"
#include "support/ray_caster.h"

namespace hemibake {
namespace {

RayOptions rays(int count) {
  RayOptions options;
  options.rays = count;
  return options;
}

// Compares outcome, facet and distance of every ray of some texels with the caster's.
void expect_agreement_with_caster(const Surface& surface, uint32_t texel_step) {
  const auto tracer = make_embree_tracer(surface, rays(64));
  const double range = height_range_m(surface) / surface.texel_size_m;
  const double lift = std::max(1e-3 * std::min(1.0, range), 0x1p-21 * range);
  int compared = 0, different = 0;
  double worst_distance = 0;
  for (uint32_t texel = 0; texel < surface.texel_count(); texel += texel_step) {
    const glm::dvec3 start(texel % static_cast<uint32_t>(surface.width()),
                           texel / static_cast<uint32_t>(surface.width()),
                           surface.heights_m[texel] / surface.texel_size_m + lift);
    for (const RayRecord& ray : tracer->replay_texel(texel)) {
      const auto cast = cast_ray(surface, start, ray.direction);
      ++compared;
      if (cast.has_value() != ray.hit || (ray.hit && cast->facet != ray.facet)) {
        ++different;
      } else if (ray.hit) {
        worst_distance =
            std::max(worst_distance, std::abs(ray.distance_m / surface.texel_size_m - cast->distance_texels));
      }
    }
  }
  ASSERT_GT(compared, 20000);
  // Rays within rounding of an edge or a grazed ridge: 1 in 4000 on rough maps.
  EXPECT_LE(different, compared / 2000) << "of " << compared << " rays";
  // Float positions inside the map are good to 10⁻⁴ texel; a grazing hit multiplies that.
  EXPECT_LT(worst_distance, 0.1);
}

TEST(EmbreeTracer, AgreesWithCasterOnRoughMap) {
  expect_agreement_with_caster(white_noise_surface(96, 80, 0.2), 7);
}

TEST(EmbreeTracer, AgreesWithCasterOnSmoothMapAcrossManyTiles) {
  expect_agreement_with_caster(synthetic_surface(SyntheticKind::kNoise, 48, 48, 0.05), 5);
}

TEST(EmbreeTracer, AgreesWithCasterOnSmallNarrowMap) {
  expect_agreement_with_caster(white_noise_surface(200, 3, 0.05), 1);
}

// On the lowest relief the first order still shows: the lift must not jump over it.
TEST(EmbreeTracer, LowReliefIsNotLost) {
  const Surface low = white_noise_surface(32, 32, 1e-6), high = white_noise_surface(32, 32, 1e-4);
  const auto hidden = [](const Surface& surface) {
    const auto tracer = make_embree_tracer(surface, rays(256));
    Row row;
    TracerCounts counts;
    double sum = 0;
    // Facet rows: cosine-weighted light that is blocked is of second order in the slope; count rays by solid
    // angle.
    for (uint32_t i = 0; i < surface.texel_count(); ++i) {
      tracer->trace_texel(i, false, row, counts);
      sum += 1 - row.visible_fraction;
    }
    return sum / surface.texel_count();
  };
  // 1 − α grows like the slope; 256 rays do not resolve 10⁻⁵, but must not invent anything either.
  EXPECT_LT(hidden(low), 1e-3);
  EXPECT_LT(hidden(high), 1e-2);
  EXPECT_GT(hidden(white_noise_surface(32, 32, 1e-2)), 1e-2);
}

}  // namespace
}  // namespace hemibake
