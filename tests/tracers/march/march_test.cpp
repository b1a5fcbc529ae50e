#include "tracers/march/march.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/statistics.h"
#include "support/maps.h"
#include "support/rows.h"
#include "tracers/embree/embree.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

constexpr double kAmplitude = 4;                               // m
constexpr double kLift = 0.01 * kAmplitude;                    // of a start, m
const double kHalfSlopeCone = 2 * std::atan(2.0) * 180 / kPi;  // its rim rises ½ m per metre

// One column of texels 1 m wide, values 0..1 of an amplitude of 4 m; flat normals, so that rays are easy to
// follow.
Surface column(const std::vector<float>& values, Edge edge = Edge::kWrap, int width = 1) {
  Grid<float> heights(width, static_cast<int>(values.size()));
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < width; ++x) heights(x, y) = values[static_cast<size_t>(y)];
  Surface surface = make_surface(heights, std::max(heights.width, heights.height), kAmplitude, edge);
  std::fill(surface.normals.values.begin(), surface.normals.values.end(), glm::vec3(0, 0, 1));
  return surface;
}

// Published rays lie on the rim where i mod N = 0, at azimuth 2π · radical inverse of N: one ray goes along
// +y, the last of two along +x, the last of four between +x and −y.
MarchOptions rim_rays(int rays) {
  MarchOptions options;
  options.rays = rays;
  options.cone_degrees = kHalfSlopeCone;
  options.ray_set = MarchRays::kMayaux2018;
  options.amplitude_m = kAmplitude;
  return options;
}

RayRecord last_ray(const Surface& surface, const MarchOptions& options, uint32_t texel) {
  return make_march_tracer(surface, options)->replay_texel(texel).back();
}

// Returns the distance to a hit in step n of a ray that rises `rise` m per metre, by the published formula.
double hit_distance(int n, double z, double rise, double here, double before) {
  const double fraction = (here - z) / (2 * z - rise + here - before);
  return (n - fraction) * std::sqrt(1 + rise * rise);
}

TEST(March, HitsAWallAndStepsBackAsPublished) {
  const RayRecord ray = last_ray(column({0, 0, 0, 0, 1, 0, 0, 0}), rim_rays(1), 0);
  EXPECT_NEAR(ray.direction.x, 0, 1e-7);
  EXPECT_NEAR(ray.direction.y, std::sqrt(0.8), 1e-7);
  EXPECT_NEAR(ray.direction.z, std::sqrt(0.2), 1e-7);
  ASSERT_TRUE(ray.hit);
  // Four steps: height 2.04 under the wall's 4, the ground 0 before: 1.96 / 7.58 of a step back.
  EXPECT_NEAR(hit_distance(4, 2.04, 0.5, 4, 0), (4 - 1.96 / 7.58) * std::sqrt(1.25), 1e-12);
  EXPECT_NEAR(ray.distance_m, hit_distance(4, 2.04, 0.5, 4, 0), 1e-6);
  EXPECT_NEAR(ray.hit_texel.y, 4 - 1.96 / 7.58, 1e-6);
  EXPECT_EQ(ray.facet, 2 * 3 + 0U);  // the cell from row 3 on
  EXPECT_EQ(ray.tiles_crossed, 0);
  const Row row = texel_row(*make_march_tracer(column({0, 0, 0, 0, 1, 0, 0, 0}), rim_rays(1)), 0);
  ASSERT_EQ(row.links.size(), 1U);
  EXPECT_EQ(row.links[0].patch, 4U);
}

TEST(March, TheFirstStepCountsFromTheLiftedStart) {
  const RayRecord ray = last_ray(column({0, 1, 0, 0, 0, 0, 0, 0}), rim_rays(1), 0);
  ASSERT_TRUE(ray.hit);
  EXPECT_NEAR(ray.distance_m, hit_distance(1, kLift + 0.5, 0.5, 4, kLift), 1e-6);
}

TEST(March, PublishedHeightsCountFromMapValueZero) {
  MarchOptions options = rim_rays(1);
  options.lookup = MarchLookup::kMayaux2018;
  options.lowest_m = 0.25 * kAmplitude;
  const RayRecord ray = last_ray(column({0.25f, 0.25f, 1, 0.25f, 0.25f}), options, 0);
  ASSERT_TRUE(ray.hit);
  EXPECT_NEAR(ray.distance_m, hit_distance(2, 1 + kLift + 1, 0.5, 4, 1), 1e-6);
}

TEST(March, AnOffsetOfTheMapChangesNothing) {
  MarchOptions options = rim_rays(64);
  const Surface surface = white_noise_surface(12, 12, kAmplitude);
  const auto expected = make_march_tracer(surface, options);
  options.lowest_m = 1000 * kAmplitude;
  const auto offset = make_march_tracer(surface, options);
  for (uint32_t texel = 0; texel < surface.texel_count(); ++texel) {
    const Row a = texel_row(*expected, texel), b = texel_row(*offset, texel);
    EXPECT_EQ(a.visible_fraction, b.visible_fraction);
    ASSERT_EQ(a.links.size(), b.links.size());
    for (size_t k = 0; k < a.links.size(); ++k) EXPECT_EQ(a.links[k].patch, b.links[k].patch);
  }
}

TEST(March, GoesOnAcrossTheSeam) {
  MarchOptions options = rim_rays(1);
  options.cone_degrees = 2 * std::atan(4.0) * 180 / kPi;  // rises ¼ a step
  const RayRecord ray = last_ray(column({0, 0, 0, 0, 1, 0, 0, 0}), options, 6);
  ASSERT_TRUE(ray.hit);
  EXPECT_NEAR(ray.distance_m, hit_distance(6, kLift + 1.5, 0.25, 4, 0), 1e-6);
  EXPECT_NEAR(ray.hit_texel.y, 6 + ray.distance_m / std::sqrt(1.0625) - 8, 1e-6);
  EXPECT_EQ(ray.tiles_crossed, 1);
}

TEST(March, OpenEdgesEndInSky) {
  const std::vector<float> values{0, 1, 0, 0, 0};
  EXPECT_TRUE(last_ray(column(values, Edge::kWrap, 2), rim_rays(1), 6).hit);
  EXPECT_FALSE(last_ray(column(values, Edge::kOpen, 2), rim_rays(1), 6).hit);
}

TEST(March, StopsAfterMaxSteps) {
  const Surface surface = column({0, 0, 0, 0, 1, 0, 0, 0});
  MarchOptions options = rim_rays(1);
  for (const int steps : {3, 4}) {
    options.max_steps = steps;
    TracerCounts counts;
    Row row;
    make_march_tracer(surface, options)->trace_texel(0, true, row, counts);
    EXPECT_EQ(row.visible_fraction, steps == 3 ? 1 : 0);
    EXPECT_EQ(counts.truncated, steps == 3 ? 1U : 0U);
    EXPECT_EQ(counts.rays, 1U);
  }
}

TEST(March, HitsBeyondTheLargestDistanceAreSky) {
  const Surface surface = column({0, 0, 0, 0, 1, 0, 0, 0});
  MarchOptions options = rim_rays(1);
  const double distance = hit_distance(4, 2.04, 0.5, 4, 0);
  options.max_distance_m = 1.0001 * distance;
  EXPECT_TRUE(last_ray(surface, options, 0).hit);
  options.max_distance_m = 0.9999 * distance;
  EXPECT_FALSE(last_ray(surface, options, 0).hit);
}

TEST(March, TheSkyBeginsAtTheAmplitude) {
  // The eighth step would be at 4.04; a wall there of the amplitude is no longer met, but one higher than the
  // amplitude (a map beyond 1) is.
  MarchOptions options = rim_rays(1);
  std::vector<float> values(16, 0);
  values[8] = 1;
  EXPECT_FALSE(last_ray(column(values), options, 0).hit);
  values[8] = 2;
  EXPECT_TRUE(last_ray(column(values), options, 0).hit);
}

TEST(March, PublishedLookupClampsAtTheSeamAndRoundsWeights) {
  // A ray between +x and −y goes √½ of a texel up the rows in a step.
  MarchOptions options = rim_rays(4);
  const double z = kLift + 0.5, fraction = 1 - std::sqrt(0.5);
  const Surface wall_before_seam = column({0, 0, 0, 1}, Edge::kWrap, 4);
  const Surface wall_after_seam = column({1, 0, 0, 0}, Edge::kWrap, 4);
  EXPECT_NEAR(last_ray(wall_before_seam, options, 0).distance_m,
              hit_distance(1, z, 0.5, 4 * (1 - fraction), kLift), 1e-6);
  EXPECT_NEAR(last_ray(wall_after_seam, options, 4).distance_m,
              hit_distance(1, z, 0.5, 4 * (1 - fraction), kLift), 1e-6);
  options.lookup = MarchLookup::kMayaux2018;
  EXPECT_NEAR(last_ray(wall_before_seam, options, 0).distance_m, hit_distance(1, z, 0.5, 4, kLift), 1e-6);
  EXPECT_NEAR(std::round(256 * fraction), 75, 0);
  EXPECT_NEAR(last_ray(wall_after_seam, options, 4).distance_m,
              hit_distance(1, z, 0.5, 4 * (1 - 75 / 256.0), kLift), 1e-6);
}

TEST(March, LongNormalsStretchTheRay) {
  const double length = 1.1;
  MarchOptions options = rim_rays(1);
  options.normal_lengths = Grid<float>(1, 8, static_cast<float>(length));
  const RayRecord ray = last_ray(column({0, 0, 0, 0, 1, 0, 0, 0}), options, 0);
  // The ray rises with 1.1 cosθ; a step is 1/√(1 − that²) of it, as if it were a unit vector.
  const double up = length * std::sqrt(0.2), along = std::sqrt(0.8), stride = 1 / std::sqrt(1 - up * up);
  int steps = 0;
  double y = 0, z = kLift, height = 0, before = 0;
  do {
    before = steps == 0 ? z : height;
    y += stride * along;
    z += stride * up;
    height = 4 * std::max(0.0, 1 - std::abs(y - 4));
    ++steps;
  } while (z >= height);
  const double fraction = (height - z) / (2 * z - stride * up + height - before);
  const double distance = (steps - fraction) * stride * std::hypot(along, up);
  ASSERT_TRUE(ray.hit);
  EXPECT_NEAR(ray.distance_m, distance, 1e-5);
  EXPECT_NEAR(ray.hit_texel.y, distance * along, 1e-5);  // not where the ray met the wall
}

TEST(March, PublishedRays) {
  MarchOptions options = mayaux2018_march();
  options.rays = 8;
  const double cos_rim = std::cos(89.5 * kPi / 180);
  const double turns[] = {0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875, 0.0625};
  const auto rays = make_march_tracer(column({0}), options)->replay_texel(0);
  ASSERT_EQ(rays.size(), 8U);
  for (int i = 0; i < 8; ++i) {
    const double cosine = cos_rim + (1 - cos_rim) * ((i + 1) % 8) / 8, sine = std::sqrt(1 - cosine * cosine);
    const double azimuth = 2 * kPi * turns[i];
    EXPECT_NEAR(glm::length(rays[i].direction -
                            glm::dvec3(sine * std::sin(azimuth), -sine * std::cos(azimuth), cosine)),
                0, 1e-7);
    EXPECT_NEAR(rays[i].cosine_weight, 2 * cosine / 8, 1e-7);
    EXPECT_EQ(rays[i].uniform_weight, 0.125);
  }
}

TEST(March, PublishedWeightsOnFlatGround) {
  const Surface surface = column({0.5f, 0.5f, 0.5f});
  MarchOptions options = mayaux2018_march();
  options.amplitude_m = kAmplitude;
  options.lowest_m = 0.5 * kAmplitude;
  const Row published = texel_row(*make_march_tracer(surface, options), 1);
  EXPECT_EQ(published.visible_fraction, 1);
  EXPECT_NEAR(published.direct_over_pi, 1.007758, 5e-7);  // 2 · mean cosθ
  EXPECT_TRUE(published.links.empty());
}

TEST(March, PublishedRowsAddUp) {
  const Surface surface = white_noise_surface(12, 12, 0.1);
  MarchOptions published = mayaux2018_march();
  published.amplitude_m = 0.1;
  double expected = 0;
  for (const RayRecord& ray : make_march_tracer(surface, published)->replay_texel(0))
    expected += ray.cosine_weight;
  EXPECT_NEAR(expected, 1.007758, 5e-7);
  const auto as_published = make_march_tracer(surface, published);
  for (uint32_t texel = 0; texel < surface.texel_count(); ++texel) {
    const Row row = texel_row(*as_published, texel);
    EXPECT_NEAR(form_factor_sum(row) + row.direct_over_pi, expected,
                1e-6);  // floats, each to 6·10⁻⁸ of itself
    for (size_t i = 1; i < row.links.size(); ++i) EXPECT_LT(row.links[i - 1].patch, row.links[i].patch);
  }
}

TEST(March, EveryMapAndAmplitudeGivesNumbers) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {7, 1}, {5, 3}}) {
    for (const double amplitude : {0.0, 1e-6, 1.0, 1e3, 1e10}) {
      for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
        if (edge == Edge::kOpen && (width < 2 || height < 2)) continue;
        const Surface surface = white_noise_surface(width, height, amplitude, edge);
        for (MarchOptions options : {MarchOptions{}, mayaux2018_march()}) {
          options.rays = 64;
          options.normal_lengths = Grid<float>(width, height, 1.05f);
          const auto tracer = make_march_tracer(surface, options);
          for (uint32_t texel = 0; texel < surface.texel_count(); ++texel) {
            const Row row = texel_row(*tracer, texel);
            EXPECT_TRUE(row.visible_fraction >= 0 && row.visible_fraction <= 1);
            EXPECT_TRUE(row.direct_over_pi >= 0 && row.direct_over_pi <= 1.1) << row.direct_over_pi;
            EXPECT_NEAR(glm::length(row.bent_normal), 1, 1e-6);
            for (const FormFactor& link : row.links) {
              EXPECT_LT(link.patch, surface.texel_count());
              EXPECT_TRUE(link.weight > 0 && link.weight <= 1.1f) << link.weight;
            }
            for (const RayRecord& ray : tracer->replay_texel(texel)) {
              EXPECT_TRUE(std::isfinite(ray.distance_m) && std::isfinite(ray.hit_texel.x));
              EXPECT_LT(ray.facet, 2 * surface.texel_count());
            }
          }
        }
      }
    }
  }
}

TEST(March, OneRayOnTheHorizonHasAllTheWeight) {
  MarchOptions options = rim_rays(1);
  options.cone_degrees = 180;
  const Row row = texel_row(*make_march_tracer(column({0, 0, 1, 0}), options), 0);
  EXPECT_EQ(row.direct_over_pi, 0);
  EXPECT_EQ(form_factor_sum(row), 1);
}

// The same rays as Embree's, so that what differs is the march: it misses what lies within its first texel
// and meets a slope late. On waves 32 texels long and at most 36° steep the horizon is further away than
// that.
TEST(March, AgreesWithEmbreeOnASmoothMap) {
  Grid<float> heights(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      heights(x, y) =
          static_cast<float>(0.5 + 0.25 * (std::sin(2 * kPi * x / 32) + std::cos(2 * kPi * y / 32)));
  const Surface surface = make_surface(heights, 1, 0.1, Edge::kWrap);
  MarchOptions march;
  march.lift_percent = 0.1;
  RayOptions rays;
  rays.patch_kind = PatchKind::kTexels;
  const LightTransport marched = trace_surface(*make_march_tracer(surface, march), KeptLinks::kNone);
  const LightTransport traced = trace_surface(*make_embree_tracer(surface, rays), KeptLinks::kNone);
  const auto& ao = marched.visible_fraction.values;
  const auto& direct = marched.direct_over_pi.values;
  // Less than one ray of the 256 a texel, and a quarter of one in the mean. What differs grazes slopes, and
  // so lies low over the ground: a quarter of that in E₀/π.
  EXPECT_LT(rms_difference(ao, traced.visible_fraction.values), 1.0 / 256);
  EXPECT_NEAR(mean(ao), mean(traced.visible_fraction.values), 0.25 / 256);
  EXPECT_LT(rms_difference(direct, traced.direct_over_pi.values), 0.25 / 256);
  EXPECT_NEAR(mean(direct), mean(traced.direct_over_pi.values), 0.0625 / 256);
}

}  // namespace
}  // namespace hemibake
