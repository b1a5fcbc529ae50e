#include "tracers/slice/slice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analytic/groove_reference.h"
#include "core/constants.h"
#include "core/parallel.h"
#include "support/maps.h"
#include "support/patch_means.h"
#include "support/rows.h"
#include "support/threads.h"
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

Row trace(const Surface& surface, uint32_t texel, const SliceOptions& options) {
  return texel_row(*make_slice_tracer(surface, options), texel);
}

LightTransport trace_all(const Surface& surface, const SliceOptions& options, bool with_links) {
  return trace_surface(*make_slice_tracer(surface, options), with_links ? KeptLinks::kAll : KeptLinks::kNone);
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
    // The horizon's tolerance; the kinks' quadrature error, about 1/azimuths², is far less.
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
    const LightTransport seen = trace_surface(*tracer, KeptLinks::kAll);
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

TEST(SliceTracer, SameBytesFromAnyNumberOfThreadsAndOneByOne) {
  const Surface surface = white_noise_surface(50, 45, 0.2);
  const SliceOptions options = azimuths(12);
  set_thread_count(1);
  const LightTransport one = trace_all(surface, options, true);
  set_thread_count(2);
  const LightTransport two = trace_all(surface, options, true);
  set_thread_count(0);
  EXPECT_EQ(one.visible_fraction.values, two.visible_fraction.values);
  EXPECT_EQ(one.direct_over_pi.values, two.direct_over_pi.values);
  EXPECT_EQ(one.patch_direct_over_pi, two.patch_direct_over_pi);
  const auto tracer = make_slice_tracer(surface, options);
  BlockRows stored;
  for (size_t b = 0; b < one.patch_form_factors.blocks.size(); ++b) {
    EXPECT_EQ(one.patch_form_factors.blocks[b].packed, two.patch_form_factors.blocks[b].packed);
  }
  for (uint32_t facet = 0; facet < tracer->patch_set().count; facet += 13) {
    const Row row = patch_row(*tracer, facet);
    unpack_block(one.patch_form_factors.blocks[facet / FormFactorMatrix::kRowsPerBlock], stored);
    float sum = 0;
    for (const FormFactor& link : row.links) sum += link.weight;
    // Packing takes less than a quantum of a weight (transport/links/form_factors.h), and drops form factors
    // smaller than that.
    const float quantum = 1.0001f * sum / (12 * static_cast<float>(row.links.size()));
    uint32_t at = stored.row_begin[facet % FormFactorMatrix::kRowsPerBlock];
    for (const FormFactor& link : row.links) {
      const bool kept = at < stored.row_begin[facet % FormFactorMatrix::kRowsPerBlock + 1] &&
                        stored.columns[at] == link.patch;
      ASSERT_NEAR(link.weight, kept ? stored.weights[at++] : 0, quantum);
    }
    EXPECT_EQ(at, stored.row_begin[facet % FormFactorMatrix::kRowsPerBlock + 1]);
  }
}

// The blocked part of a tilted hemisphere over flat ground meets the triangles at the texel itself.
TEST(SliceTracer, TiltedHemisphereMeetsTheGroundAtItsTexel) {
  Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8);
  const double tilt = kPi / 6;
  for (auto& normal : surface.normals.values) normal = glm::vec3(std::sin(tilt), 0, std::cos(tilt));
  const Row row = trace(surface, 9, azimuths(64));
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

TEST(SliceTracer, MaxDistanceClipsIntervals) {
  const Surface surface = synthetic_surface(SyntheticKind::kCanyon, 64, 64, 0.5);
  const uint32_t middle_of_floor = 32 * 64 + 32;
  SliceOptions options = azimuths(256);
  options.max_distance_m = 0.4;
  const Row row = trace(surface, middle_of_floor, options);
  EXPECT_GT(row.visible_fraction, trace(surface, middle_of_floor, azimuths(256)).visible_fraction + 0.1);
  EXPECT_LT(row.visible_fraction, 0.9);
  EXPECT_NEAR(row_sum(row), 1, 0x1p-25);  // complete_row: the rounding of one weight
  options.max_distance_m = 1e9;           // as far as everything: the same to the horizon's tolerance
  EXPECT_NEAR(trace(surface, middle_of_floor, options).visible_fraction,
              trace(surface, middle_of_floor, azimuths(256)).visible_fraction, 1e-4);
}

// Azimuths near the grid lines and the diagonals end, on a wrapping map too, where a path along a line of
// texels lower than the highest would go on to the far limit.
TEST(SliceTracer, AzimuthsNearGridLinesEnd) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = white_noise_surface(64, 64, 0.1, edge);
    for (const int count : {1, 2, 4, 6, 8, 10, 512}) {
      const LightTransport seen = trace_all(surface, azimuths(count), true);
      for (const float ao : seen.visible_fraction.values) ASSERT_TRUE(ao >= 0 && ao <= 1);
    }
  }
}

}  // namespace
}  // namespace hemibake
