#include "tracers/slice/slice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

#include "analytic/groove_reference.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "support/threads.h"
#include "core/statistics.h"
#include "support/maps.h"
#include "support/patch_means.h"
#include "surface/facets.h"
#include "surface/synthetic/analytic.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

SliceOptions azimuths(int count, PatchKind patches = PatchKind::kFacets) {
  SliceOptions options;
  options.azimuths = count;
  options.patch_kind = patches;
  return options;
}

Row trace(const Surface& surface, uint32_t texel, const SliceOptions& options, bool with_links = true) {
  Row row;
  TracerCounts counts;
  make_slice_tracer(surface, options)->trace_texel(texel, with_links, row, counts);
  return row;
}

double row_sum(const Row& row) {
  double sum = static_cast<double>(static_cast<float>(row.direct_over_pi));
  for (const FormFactor& link : row.links) sum += static_cast<double>(link.weight);
  return sum;
}

LightTransport look(const Surface& surface, const SliceOptions& options, bool with_links) {
  return trace_surface(*make_slice_tracer(surface, options), with_links);
}

TEST(SliceTracer, FlatGroundIsExactlyOpen) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = synthetic_surface(SyntheticKind::kFlat, 40, 5, 0.1, {}, edge);
    for (const int count : {1, 3, 64}) {
      for (const bool with_links : {false, true}) {
        const Row row = trace(surface, 77, azimuths(count), with_links);
        EXPECT_EQ(row.visible_fraction, 1);
        EXPECT_EQ(row.direct_over_pi, 1);
        EXPECT_TRUE(row.links.empty());
      }
    }
  }
}

// A canyon floor between walls whose upper edges are d₁ and d₂ away: U = 1 − (a₁ + a₂)/π, C = (cos a₁ + cos
// a₂)/2. The walls are long, so that only the azimuths are sampled: a smooth periodic integrand but for the
// kink along the walls.
TEST(SliceTracer, CanyonFloor) {
  const Surface surface = synthetic_surface(SyntheticKind::kCanyon, 64, 64, 0.5);
  const WallGeometry walls = canyon_geometry(64);
  const double depth = 0.5 * 64;
  for (int x = walls.left_edge + 2; x < walls.right_edge - 1; x += 5) {
    const double a1 = std::atan(depth / (x - walls.left_edge)),
                 a2 = std::atan(depth / (walls.right_edge - x));
    const Row row = trace(surface, static_cast<uint32_t>(20 * 64 + x), azimuths(512));
    // The kinks' quadrature error falls like 1/azimuths².
    EXPECT_NEAR(row.visible_fraction, 1 - (a1 + a2) / kPi, 1e-4) << x;
    EXPECT_NEAR(row.direct_over_pi, (std::cos(a1) + std::cos(a2)) / 2, 1e-4) << x;
  }
}

TEST(SliceTracer, LongWallWithOpenEdges) {
  const int width = 128, height = 1024;
  const Surface surface = synthetic_surface(SyntheticKind::kStep, width, height, 0.02, {}, Edge::kOpen);
  const WallGeometry walls = step_geometry(width);
  const double wall_height = 0.02 * height;
  for (const int distance : {5, 20, 50}) {
    const double a = std::atan(wall_height / distance);
    const Row row =
        trace(surface, static_cast<uint32_t>(height / 2 * width + walls.left_edge + distance), azimuths(512));
    // The wall ends after ± 512 texels: what is missing beyond is less than distance · height / 512² / π of
    // α.
    const double ends = distance * wall_height / (512.0 * 512.0 * kPi) +
                        2.0 * std::atan(distance / 512.0) / kPi * std::atan(wall_height / 512.0) / kPi;
    EXPECT_NEAR(row.visible_fraction, 1 - a / kPi, ends + 1e-4) << distance;
    EXPECT_NEAR(row.direct_over_pi, (1 + std::cos(a)) / 2, ends + 1e-4) << distance;
  }
}

// The wall means of E_b/π between facets, which are exactly the walls of the groove. With texels as wide as
// 1/32 of a wall and light linear between nodes half a texel apart the means are right to about 1/64² of E_b.
TEST(SliceTracer, GrooveWallMeans) {
  for (const double degrees : {45.0, 30.0}) {
    const double psi = degrees * kPi / 180;
    const Surface surface = synthetic_surface(SyntheticKind::kGroove, 128, 16, {}, psi);
    const auto tracer = make_slice_tracer(surface, azimuths(128));
    const LightTransport seen = trace_surface(*tracer, true);
    std::vector<double> light(seen.patch_direct_over_pi.begin(), seen.patch_direct_over_pi.end()),
        next(light.size());
    const std::vector<double> expected = groove_wall_means(psi, 4);
    for (const double mean_light : expected) {
      EXPECT_NEAR(area_mean(surface, tracer->patch_set(), std::span<const double>(light)), mean_light,
                  2e-3 * std::sqrt(mean_light))
          << degrees;
      multiply(seen.patch_form_factors, light, next);
      light.swap(next);
    }
  }
}

// The bottom of a spherical cap: U = 1 − sin(T/2) and C = (1 + cos T)/2 there.
TEST(SliceTracer, BottomOfABowl) {
  const double angle = 60 * kPi / 180;
  const Surface surface = synthetic_surface(SyntheticKind::kBowl, 257, 257, {}, angle);
  const BowlGeometry bowl = bowl_geometry(257, 257, angle);
  const uint32_t bottom = static_cast<uint32_t>(bowl.center_y * 257 + bowl.center_x);
  const Row row = trace(surface, bottom, azimuths(256));
  // The rim lies up to a texel outside the last texels below it, and the flat ground around does not rise:
  // half a texel of the rim's radius in the tangent of the horizon.
  const double discretisation = 0.5 / bowl.rim_radius;
  EXPECT_NEAR(row.visible_fraction, 1 - std::sin(angle / 2), discretisation);
  EXPECT_NEAR(row.direct_over_pi, (1 + std::cos(angle)) / 2, discretisation);
}

TEST(SliceTracer, RowsSumToOneAndNameRealPatches) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = white_noise_surface(37, 21, 0.3, edge);
    for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels}) {
      for (const int count : {1, 3, 32}) {
        const auto tracer = make_slice_tracer(surface, azimuths(count, patches));
        Row row;
        TracerCounts counts;
        const auto expect_whole = [&] {
          EXPECT_NEAR(row_sum(row), 1, 1e-7);
          for (const FormFactor& link : row.links) {
            ASSERT_LT(link.patch, tracer->patch_set().count);
            ASSERT_GE(link.weight, 0);
          }
        };
        for (uint32_t i = 0; i < surface.texel_count(); ++i) {
          tracer->trace_texel(i, true, row, counts);
          expect_whole();
        }
        for (uint32_t i = 0; i < tracer->patch_set().count; ++i) {
          tracer->trace_patch(i, true, row, counts);
          expect_whole();
        }
      }
    }
  }
}

TEST(SliceTracer, FacetsNeverSeeThemselves) {
  for (const double amplitude : {1e-6, 0.1, 1e3}) {
    const Surface surface = white_noise_surface(24, 24, amplitude);
    const auto tracer = make_slice_tracer(surface, azimuths(64));
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

// A map shifted round by some texels is the same endless surface.
TEST(SliceTracer, NoSeam) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 40, 40, 0.3);
  Surface shifted = surface;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      shifted.heights_m((x + 19) % 40, (y + 23) % 40) = surface.heights_m(x, y);
      shifted.normals((x + 19) % 40, (y + 23) % 40) = surface.normals(x, y);
    }
  // 512 azimuths leave no choice of turns: packets differ, the azimuths do not.
  const LightTransport seen = look(surface, azimuths(512), false),
                       other = look(shifted, azimuths(512), false);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      EXPECT_NEAR(seen.visible_fraction(x, y), other.visible_fraction((x + 19) % 40, (y + 23) % 40), 1e-6);
      EXPECT_NEAR(seen.direct_over_pi(x, y), other.direct_over_pi((x + 19) % 40, (y + 23) % 40), 1e-6);
    }
}

TEST(SliceTracer, SameBytesFromAnyNumberOfThreadsAndOneByOne) {
  const Surface surface = white_noise_surface(50, 45, 0.2);
  const SliceOptions options = azimuths(12);
  set_thread_count(1);
  const LightTransport one = look(surface, options, true);
  set_thread_count(2);
  const LightTransport two = look(surface, options, true);
  set_thread_count(0);
  EXPECT_EQ(one.visible_fraction.values, two.visible_fraction.values);
  EXPECT_EQ(one.direct_over_pi.values, two.direct_over_pi.values);
  EXPECT_EQ(one.patch_direct_over_pi, two.patch_direct_over_pi);
  const auto tracer = make_slice_tracer(surface, options);
  Row row;
  TracerCounts counts;
  BlockRows stored;
  for (size_t b = 0; b < one.patches.blocks.size(); ++b) {
    EXPECT_EQ(one.patches.blocks[b].packed, two.patches.blocks[b].packed);
  }
  for (uint32_t facet = 0; facet < tracer->patch_set().count; facet += 13) {
    tracer->trace_patch(facet, true, row, counts);
    unpack_block(one.patches.blocks[facet / FormFactorMatrix::kRowsPerBlock], stored);
    float sum = 0;
    for (const FormFactor& link : row.links) sum += link.weight;
    // Packing takes less than a quantum of a weight (transport/links/form_factors.h), and the links that this
    // leaves nothing of.
    const float quantum = 1.0001f * sum / (12 * static_cast<float>(row.links.size()));
    uint32_t at = stored.row_begin[facet % FormFactorMatrix::kRowsPerBlock];
    for (const FormFactor& link : row.links) {
      const bool kept = at < stored.row_begin[facet % FormFactorMatrix::kRowsPerBlock + 1] &&
                        stored.patches[at] == link.patch;
      ASSERT_NEAR(link.weight, kept ? stored.weights[at++] : 0, quantum);
    }
    EXPECT_EQ(at, stored.row_begin[facet % FormFactorMatrix::kRowsPerBlock + 1]);
  }
}

// With links the walk looks below the horizontal too, but sees the same sky; it may end elsewhere within the
// horizon's tolerance of 10⁻⁴.
TEST(SliceTracer, LinksDoNotChangeTheSky) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = white_noise_surface(33, 30, 0.1, edge);
    const LightTransport with = look(surface, azimuths(16), true),
                         without = look(surface, azimuths(16), false);
    for (size_t i = 0; i < surface.texel_count(); ++i) {
      EXPECT_NEAR(with.visible_fraction[i], without.visible_fraction[i], 1e-4);
      EXPECT_NEAR(with.direct_over_pi[i], without.direct_over_pi[i], 1e-4);
    }
  }
}

TEST(SliceTracer, NormalsFromAMapTiltTheHemisphere) {
  Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8);
  const double tilt = kPi / 6;
  for (auto& normal : surface.normals.values) normal = glm::vec3(std::sin(tilt), 0, std::cos(tilt));
  const Row row = trace(surface, 9, azimuths(512));
  // A hemisphere tilted by t over flat ground: 1 − t/π of its directions and (1 + cos t)/2 of its cosine are
  // sky; the rest meets the triangles at the texel itself.
  EXPECT_NEAR(row.visible_fraction, 1 - tilt / kPi, 2e-5);
  EXPECT_NEAR(row.direct_over_pi, (1 + std::cos(tilt)) / 2, 2e-5);
  EXPECT_GT(row.links.size(), 0);
  const PatchSet patches = make_patches(surface, PatchKind::kFacets);
  for (const FormFactor& link : row.links) {
    bool touches = false;
    const uint32_t facet = facet_node(patches, link.patch).facet;
    for (const glm::ivec2& corner : facet_corners(surface, facet).texel)
      touches = touches || (corner.x % 8 == 1 && corner.y % 8 == 1);
    EXPECT_TRUE(touches) << link.patch;
  }
  const Row texels = trace(surface, 9, azimuths(64, PatchKind::kTexels));
  ASSERT_EQ(texels.links.size(), 1u);
  EXPECT_EQ(texels.links[0].patch, 9u);
}

TEST(SliceTracer, MaxDistanceTurnsFarHitsIntoSky) {
  const Surface surface = synthetic_surface(SyntheticKind::kCanyon, 64, 64, 0.5);
  const uint32_t middle_of_floor = 32 * 64 + 32;
  SliceOptions options = azimuths(256);
  options.max_distance_m = 0.1;
  EXPECT_NEAR(trace(surface, middle_of_floor, options).visible_fraction, 1, 1e-6);
  options.max_distance_m = 0.4;
  const Row row = trace(surface, middle_of_floor, options);
  EXPECT_GT(row.visible_fraction, trace(surface, middle_of_floor, azimuths(256)).visible_fraction + 0.1);
  EXPECT_LT(row.visible_fraction, 0.9);
  EXPECT_NEAR(row_sum(row), 1, 1e-6);
  options.max_distance_m = 1e9;
  EXPECT_NEAR(trace(surface, middle_of_floor, options).visible_fraction,
              trace(surface, middle_of_floor, azimuths(256)).visible_fraction, 1e-4);
}

TEST(SliceTracer, OpenEdgesLetLightInFromTheSide) {
  const Surface wrapped = synthetic_surface(SyntheticKind::kStep, 64, 64, 0.5);
  const Surface open = synthetic_surface(SyntheticKind::kStep, 64, 64, 0.5, {}, Edge::kOpen);
  const uint32_t last_column = 32 * 64 + 62;
  EXPECT_GT(trace(open, last_column, azimuths(64)).visible_fraction,
            trace(wrapped, last_column, azimuths(64)).visible_fraction + 0.3);
}

TEST(SliceTracer, ExtremesStayFinite) {
  for (const double amplitude : {0.0, 1e-6, 1e3}) {
    for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
      for (const auto& [width, height] : {std::pair{1, 1}, {1, 37}, {37, 1}, {2, 2}, {33, 17}}) {
        if (edge == Edge::kOpen && (width < 2 || height < 2)) continue;
        const Surface surface = white_noise_surface(width, height, amplitude, edge);
        for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels}) {
          const auto tracer = make_slice_tracer(surface, azimuths(16, patches));
          Row row;
          TracerCounts counts;
          for (uint32_t i = 0; i < std::min(surface.texel_count(), tracer->patch_set().count); ++i) {
            for (const bool with_links : {false, true}) {
              tracer->trace_texel(i, with_links, row, counts);
              ASSERT_GE(row.visible_fraction, 0);
              ASSERT_LE(row.visible_fraction, 1);
              ASSERT_NEAR(glm::length(row.bent_normal), 1, 1e-6);
              if (with_links) {
                ASSERT_NEAR(row_sum(row), 1, 1e-6);
              }
            }
            tracer->trace_patch(i, true, row, counts);
            ASSERT_NEAR(row_sum(row), 1, 1e-6);
          }
        }
      }
    }
  }
}

// Azimuths near the grid lines and the diagonals end, on a wrapping map too, where a path along a line of
// texels lower than the highest would go on to the far limit.
TEST(SliceTracer, AzimuthsNearGridLinesEnd) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = white_noise_surface(64, 64, 0.1, edge);
    for (const int count : {1, 2, 4, 6, 8, 10, 512}) {
      const LightTransport seen = look(surface, azimuths(count), true);
      for (const float ao : seen.visible_fraction.values) ASSERT_TRUE(ao >= 0 && ao <= 1);
    }
  }
}

TEST(SliceTracer, ReplayAddsUpToTheRow) {
  const Surface surface = white_noise_surface(32, 32, 0.2);
  const auto tracer = make_slice_tracer(surface, azimuths(32));
  for (const uint32_t texel : {0u, 500u, 1023u}) {
    Row row;
    TracerCounts counts;
    tracer->trace_texel(texel, true, row, counts);
    double uniform = 0, direct = 0, hit = 0;
    for (const RayRecord& record : tracer->replay_texel(texel)) {
      (record.hit ? hit : direct) += record.cosine_weight;
      if (!record.hit) uniform += record.uniform_weight;
      EXPECT_NEAR(glm::length(record.direction), 1, 1e-12);
      EXPECT_LT(record.facet, facet_count(surface));
    }
    EXPECT_NEAR(uniform, row.visible_fraction, 1e-5);
    EXPECT_NEAR(direct, row.direct_over_pi, 1e-5);
    EXPECT_NEAR(direct + hit, 1, 1e-5);
  }
}

// The facets' light adds up to what falls through the opening.
TEST(SliceTracer, FacetLightAddsUpToTheOpening) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 64, 64, 0.1);
  const auto tracer = make_slice_tracer(surface, azimuths(64));
  Row row;
  TracerCounts counts;
  std::vector<double> light;
  for (uint32_t patch = 0; patch < tracer->patch_set().count; ++patch) {
    tracer->trace_patch(patch, false, row, counts);
    light.push_back(row.direct_over_pi);
  }
  // The rule over the nodes misses 0.117 % of the light along the folds of this map, whose slopes turn by 5°
  // a texel; 64 azimuths leave 0.004 % rms.
  EXPECT_NEAR(sum_over_opening(surface, tracer->patch_set(), std::span<const double>(light)), 1, 1.5e-3);
}

}  // namespace
}  // namespace hemibake
