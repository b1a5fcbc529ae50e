#include "tracers/embree/embree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "support/height_walk.h"
#include "support/maps.h"
#include "support/patch_means.h"
#include "surface/normals.h"

namespace hemibake {
namespace {

RayOptions rays(int count) {
  RayOptions options;
  options.rays = count;
  return options;
}

Row trace(const Tracer& tracer, uint32_t texel) {
  Row row;
  TracerCounts counts;
  tracer.trace_texel(texel, true, row, counts);
  return row;
}

double row_sum(const Row& row) {
  double sum = static_cast<double>(static_cast<float>(row.direct_over_pi));
  for (const FormFactor& link : row.links) sum += static_cast<double>(link.weight);
  return sum;
}

// Every ray of some texels against the walk: which fate, which facet, how far.
void expect_agreement_with_walk(const Surface& surface, uint32_t texel_step) {
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
      const auto walked = walk_ray(surface, start, ray.direction);
      ++compared;
      if (walked.has_value() != ray.hit || (ray.hit && walked->facet != ray.facet)) {
        ++different;
      } else if (ray.hit) {
        worst_distance = std::max(worst_distance,
                                  std::abs(ray.distance_m / surface.texel_size_m - walked->distance_texels));
      }
    }
  }
  ASSERT_GT(compared, 20000);
  EXPECT_LE(different, compared / 2000) << "of " << compared << " rays";
  // Float positions inside the map are good to 10⁻⁴ texel; a grazing hit multiplies that.
  EXPECT_LT(worst_distance, 0.1);
}

TEST(EmbreeTracer, AgreesWithWalkOnRoughMap) {
  expect_agreement_with_walk(white_noise_surface(96, 80, 0.2), 7);
}

TEST(EmbreeTracer, AgreesWithWalkOnSmoothMapAcrossManyTiles) {
  expect_agreement_with_walk(synthetic_surface(SyntheticKind::kNoise, 48, 48, 0.05), 5);
}

TEST(EmbreeTracer, AgreesWithWalkOnSmallNarrowMap) {
  expect_agreement_with_walk(white_noise_surface(200, 3, 0.05), 1);
}

TEST(EmbreeTracer, FlatGroundIsExactlyOpen) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = synthetic_surface(SyntheticKind::kFlat, 4, 5, 0.1, {}, edge);
    for (const DirectionSet set : {DirectionSet::kUniform, DirectionSet::kCosine}) {
      RayOptions options = rays(100);
      options.directions = set;
      const Row row = trace(*make_embree_tracer(surface, options), 7);
      EXPECT_EQ(row.visible_fraction, 1);
      EXPECT_EQ(row.direct_over_pi, 1);
      EXPECT_TRUE(row.links.empty());
      // A hundred directions balance to 0.1 rad; cosine-weighted ones are few near the horizon.
      EXPECT_GT(row.bent_normal.z, std::cos(0.1));
    }
  }
}

TEST(EmbreeTracer, RowsSumToOne) {
  const Surface surface = white_noise_surface(32, 32, 0.3);
  for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels}) {
    for (const int count : {1, 3, 100, 256}) {
      RayOptions options = rays(count);
      options.patch_kind = patches;
      const auto tracer = make_embree_tracer(surface, options);
      Row row;
      TracerCounts counts;
      for (uint32_t i = 0; i < surface.texel_count(); ++i) {
        tracer->trace_texel(i, true, row, counts);
        EXPECT_NEAR(row_sum(row), 1, 1e-7);
        tracer->trace_patch(i, true, row, counts);
        EXPECT_NEAR(row_sum(row), 1, 1e-7);
        for (const FormFactor& link : row.links) ASSERT_LT(link.patch, tracer->patch_set().count);
      }
    }
  }
}

TEST(EmbreeTracer, FacetsNeverSeeThemselves) {
  for (const double amplitude : {1e-6, 0.1, 1e3}) {
    const Surface surface = white_noise_surface(24, 24, amplitude);
    const auto tracer = make_embree_tracer(surface, rays(64));
    Row row;
    TracerCounts counts;
    const PatchSet& patches = tracer->patch_set();
    for (uint32_t patch = 0; patch < patches.count; ++patch) {
      tracer->trace_patch(patch, true, row, counts);
      for (const FormFactor& link : row.links)
        EXPECT_NE(facet_node(patches, link.patch).facet, facet_node(patches, patch).facet);
    }
  }
}

// A map shifted round by some texels is the same endless surface: with one ray set for all (the rotation
// depends on the texel's number, so compare averages over rotations) the seam must not show.
TEST(EmbreeTracer, NoSeam) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 40, 40, 0.3);
  Surface shifted = surface;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      shifted.heights_m((x + 20) % 40, (y + 20) % 40) = surface.heights_m(x, y);
      shifted.normals((x + 20) % 40, (y + 20) % 40) = surface.normals(x, y);
    }
  constexpr int kRays = 4096;
  const auto tracer = make_embree_tracer(surface, rays(kRays)),
             other = make_embree_tracer(shifted, rays(kRays));
  Row row, other_row;
  TracerCounts counts;
  for (int x = 0; x < 40; ++x) {
    tracer->trace_texel(static_cast<uint32_t>(x), false, row, counts);  // row 0: on the seam
    other->trace_texel(static_cast<uint32_t>(20 * 40 + (x + 20) % 40), false, other_row, counts);
    // N^-3/4 for a low-discrepancy set (FACTS.md §6), with a constant of 2 (measured 0.5) on each side.
    EXPECT_NEAR(row.visible_fraction, other_row.visible_fraction, 4 * std::pow(kRays, -0.75)) << x;
  }
}

TEST(EmbreeTracer, MaxDistanceTurnsFarHitsIntoSky) {
  const Surface surface = synthetic_surface(SyntheticKind::kCanyon, 64, 64, 0.5);
  RayOptions options = rays(1024);
  const uint32_t middle_of_floor = 32 * 64 + 32;
  const Row far = trace(*make_embree_tracer(surface, options), middle_of_floor);
  options.max_distance_m = 0.1;
  const Row near = trace(*make_embree_tracer(surface, options), middle_of_floor);
  EXPECT_LT(far.visible_fraction, 0.6);
  EXPECT_EQ(near.visible_fraction, 1);
}

TEST(EmbreeTracer, OpenEdgesLetLightInFromTheSide) {
  const Surface wrapped = synthetic_surface(SyntheticKind::kStep, 64, 64, 0.5);
  const Surface open = synthetic_surface(SyntheticKind::kStep, 64, 64, 0.5, {}, Edge::kOpen);
  const uint32_t last_column = 32 * 64 + 62;
  EXPECT_GT(trace(*make_embree_tracer(open, rays(1024)), last_column).visible_fraction,
            trace(*make_embree_tracer(wrapped, rays(1024)), last_column).visible_fraction + 0.3);
}

TEST(EmbreeTracer, NormalsFromAMapTiltTheHemisphere) {
  Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8);
  const double tilt = kPi / 6;
  for (auto& normal : surface.normals.values) normal = glm::vec3(std::sin(tilt), 0, std::cos(tilt));
  const Row row = trace(*make_embree_tracer(surface, rays(4096)), 9);
  // A hemisphere tilted by t over flat ground: 1 − t/π of its directions and (1 + cos t)/2 of its cosine are
  // sky.
  EXPECT_NEAR(row.visible_fraction, 1 - tilt / kPi, 2 * std::pow(4096, -0.75));
  EXPECT_NEAR(row.direct_over_pi, (1 + std::cos(tilt)) / 2, 2 * std::pow(4096, -0.75));
}

TEST(EmbreeTracer, ExtremesStayFinite) {
  for (const double amplitude : {0.0, 1e-6, 1e3}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 37}, {37, 1}, {2, 2}, {33, 17}}) {
      const Surface surface = white_noise_surface(width, height, amplitude);
      for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels}) {
        RayOptions options = rays(32);
        options.patch_kind = patches;
        const auto tracer = make_embree_tracer(surface, options);
        Row row;
        TracerCounts counts;
        for (uint32_t i = 0; i < surface.texel_count(); ++i) {
          tracer->trace_texel(i, true, row, counts);
          ASSERT_GE(row.visible_fraction, 0);
          ASSERT_LE(row.visible_fraction, 1);
          ASSERT_NEAR(glm::length(row.bent_normal), 1, 1e-6);
          ASSERT_NEAR(row_sum(row), 1, 1e-6);
          tracer->trace_patch(i, true, row, counts);
          ASSERT_NEAR(row_sum(row), 1, 1e-6);
        }
      }
    }
  }
}

// On the lowest relief the first-order answer still comes out: the lift must not jump over it.
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

// A height field always lets light out: on a rough map no facet may lose rays through the ground, and the
// facets' light adds up to what falls through the opening.
TEST(EmbreeTracer, FacetLightAddsUpToTheOpening) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 64, 64, 0.2);
  const auto tracer = make_embree_tracer(surface, rays(256));
  Row row;
  TracerCounts counts;
  std::vector<double> light;
  double variance = 0;  // of the sum, at most: rays are stratified
  for (uint32_t patch = 0; patch < tracer->patch_set().count; ++patch) {
    tracer->trace_patch(patch, false, row, counts);
    light.push_back(row.direct_over_pi);
    const double share =
        patch_area_texels(surface, tracer->patch_set(), patch) / (0.5 * facet_count(surface));
    variance += share * share * light.back() * (1 - light.back()) / 256;
  }
  // The rule over the nodes of a facet errs by up to 0.2 % on rough maps (surface/patches.h).
  EXPECT_NEAR(sum_over_opening(surface, tracer->patch_set(), std::span<const double>(light)), 1,
              0.002 + 3 * std::sqrt(variance));
}

}  // namespace
}  // namespace hemibake
