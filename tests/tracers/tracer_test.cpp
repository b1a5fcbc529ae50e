// Tests that every tracer passes, whatever it is made of.
#include "tracers/tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "support/maps.h"
#include "support/patch_means.h"
#include "support/rows.h"
#include "surface/facets.h"
#include "tracers/embree/embree.h"
#include "tracers/march/march.h"
#include "tracers/slice/slice.h"

namespace hemibake {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

// Rays: a low-discrepancy set of N errs by N^−¾, with a constant of 2 (0.5 measured).
struct RayErrors {
  static constexpr int kMany = 4096;
  static double sampling() { return 2 * std::pow(kMany, -0.75); }
  static constexpr double kReplay = 1e-12;  // sums of doubles
  static constexpr double kLinksOnSky = 0;  // the same rays
  // Each of two sets errs: the rotation depends on the texel's number.
  static double seam() { return 2 * sampling(); }
};

// Slices: exact in elevation; kinks along the azimuth are integrated to about 1/N².
struct SliceErrors {
  static constexpr int kMany = 512;
  static double sampling() { return 2e-5; }
  static constexpr double kReplay = 1e-5;      // float vectors, 10⁻⁷ each, over the azimuths
  static constexpr double kLinksOnSky = 1e-4;  // the horizon's tolerance: azimuths may end elsewhere
  static double seam() { return 1e-6; }        // 512 azimuths have one rotation: packets differ, they do not
};

template <PatchKind kKind>
struct Embree : RayErrors {
  static std::unique_ptr<Tracer> make(const Surface& surface, int rays, uint64_t seed = 0,
                                      double max_distance_m = kFar) {
    RayOptions options;
    options.rays = rays;
    options.seed = seed;
    options.max_distance_m = max_distance_m;
    options.patch_kind = kKind;
    return make_embree_tracer(surface, options);
  }
};

template <PatchKind kKind>
struct Slice : SliceErrors {
  static std::unique_ptr<Tracer> make(const Surface& surface, int azimuths, uint64_t seed = 0,
                                      double max_distance_m = kFar) {
    SliceOptions options;
    options.azimuths = azimuths;
    options.seed = seed;
    options.max_distance_m = max_distance_m;
    options.patch_kind = kKind;
    return make_slice_tracer(surface, options);
  }
};

struct March : RayErrors {
  static std::unique_ptr<Tracer> make(const Surface& surface, int rays, uint64_t seed = 0,
                                      double max_distance_m = kFar) {
    MarchOptions options;
    options.rays = rays;
    options.seed = seed;
    options.max_distance_m = max_distance_m;
    return make_march_tracer(surface, options);
  }
};

struct Names {
  template <class Maker>
  static std::string GetName(int) {
    if (std::is_same_v<Maker, Embree<PatchKind::kFacets>>) return "Embree";
    if (std::is_same_v<Maker, Embree<PatchKind::kTexels>>) return "EmbreeTexels";
    if (std::is_same_v<Maker, Slice<PatchKind::kFacets>>) return "Slice";
    if (std::is_same_v<Maker, Slice<PatchKind::kTexels>>) return "SliceTexels";
    return "March";
  }
};

template <class Maker>
class EveryTracer : public testing::Test {};
using Makers = testing::Types<Embree<PatchKind::kFacets>, Embree<PatchKind::kTexels>,
                              Slice<PatchKind::kFacets>, Slice<PatchKind::kTexels>, March>;
TYPED_TEST_SUITE(EveryTracer, Makers, Names);

template <class Maker>
class EveryNodeTracer : public testing::Test {};
using NodeMakers = testing::Types<Embree<PatchKind::kFacets>, Slice<PatchKind::kFacets>>;
TYPED_TEST_SUITE(EveryNodeTracer, NodeMakers, Names);

// Checks the invariants of a row with form factors.
void expect_valid(const Row& row, const Tracer& tracer) {
  // complete_row leaves the rounding of one weight below 1: half of 2⁻²⁴.
  EXPECT_NEAR(row_sum(row), 1, 0x1p-25);
  EXPECT_TRUE(row.visible_fraction >= 0 && row.visible_fraction <= 1) << row.visible_fraction;
  EXPECT_TRUE(row.direct_over_pi >= 0 && row.direct_over_pi <= 1) << row.direct_over_pi;
  EXPECT_NEAR(glm::length(row.bent_normal), 1, 1e-6);  // float normals
  for (size_t i = 0; i < row.links.size(); ++i) {
    ASSERT_LT(row.links[i].patch, tracer.patch_set().count);
    ASSERT_GE(row.links[i].weight, 0);
    if (i > 0) {
      ASSERT_LT(row.links[i - 1].patch, row.links[i].patch);
    }
  }
}

void expect_same(const Row& row, const Row& other) {
  EXPECT_EQ(row.visible_fraction, other.visible_fraction);
  EXPECT_EQ(row.direct_over_pi, other.direct_over_pi);
  EXPECT_EQ(row.bent_normal, other.bent_normal);
  ASSERT_EQ(row.links.size(), other.links.size());
  for (size_t i = 0; i < row.links.size(); ++i) {
    EXPECT_EQ(row.links[i].patch, other.links[i].patch);
    EXPECT_EQ(row.links[i].weight, other.links[i].weight);
  }
}

TYPED_TEST(EveryTracer, FlatGroundIsExactlyOpen) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen, Edge::kGround}) {
    const Surface surface = synthetic_surface(SyntheticKind::kFlat, 40, 5, 0.1, {}, edge);
    for (const int rays : {1, 3, 100}) {
      const auto tracer = TypeParam::make(surface, rays);
      for (const bool with_links : {false, true}) {
        const Row texel = texel_row(*tracer, 77, with_links), patch = patch_row(*tracer, 77, with_links);
        for (const Row& row : {texel, patch}) {
          EXPECT_EQ(row.visible_fraction, 1);
          EXPECT_EQ(row.direct_over_pi, 1);
          EXPECT_TRUE(row.links.empty());
        }
        // A hundred directions balance to 0.1 rad; a node has fewer.
        if (rays == 100) {
          EXPECT_GT(texel.bent_normal.z, std::cos(0.1));
        }
      }
    }
  }
}

TYPED_TEST(EveryTracer, RowsSumToOneAndNamePatchesInOrder) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen, Edge::kGround}) {
    const Surface surface = white_noise_surface(37, 21, 0.3, edge);
    for (const int rays : {1, 3, 64}) {
      const auto tracer = TypeParam::make(surface, rays);
      for (uint32_t i = 0; i < surface.texel_count(); ++i) expect_valid(texel_row(*tracer, i), *tracer);
      for (uint32_t i = 0; i < tracer->patch_set().count; ++i) expect_valid(patch_row(*tracer, i), *tracer);
    }
  }
}

TYPED_TEST(EveryTracer, CountsItsRays) {
  const Surface surface = white_noise_surface(12, 10, 0.3);
  const auto tracer = TypeParam::make(surface, 16);
  TracerCounts counts;
  std::vector<Row> rows(surface.texel_count());
  tracer->trace_texels(0, true, rows, counts);
  EXPECT_EQ(counts.rays, 16 * rows.size());
  EXPECT_LE(counts.truncated, counts.rays);
}

TYPED_TEST(EveryTracer, SameAloneAndInCompany) {
  const Surface surface = white_noise_surface(77, 35, 0.2);
  const auto tracer = TypeParam::make(surface, 12);
  TracerCounts counts;
  std::vector<Row> rows(500);
  for (const bool with_links : {false, true}) {
    tracer->trace_texels(41, with_links, rows, counts);
    for (uint32_t i = 0; i < rows.size(); ++i) expect_same(rows[i], texel_row(*tracer, 41 + i, with_links));
    tracer->trace_patches(1003, with_links, rows, counts);
    for (uint32_t i = 0; i < rows.size(); ++i) expect_same(rows[i], patch_row(*tracer, 1003 + i, with_links));
  }
  const TexelTile tile{5, 3, 25, 20};
  tracer->trace_tile(tile, rows, counts);
  for (uint32_t i = 0; i < rows.size(); ++i)
    expect_same(rows[i], texel_row(*tracer, (3 + i / 25) * 77 + 5 + i % 25, false));
}

TYPED_TEST(EveryTracer, ReseededIsTheTracerOfThatSeed) {
  const Surface surface = white_noise_surface(33, 20, 0.2);
  const auto tracer = TypeParam::make(surface, 16), other = TypeParam::make(surface, 16, 5);
  const auto reseeded = tracer->reseeded(5);
  int changed = 0;
  for (uint32_t i = 0; i < surface.texel_count(); i += 7) {
    expect_same(texel_row(*reseeded, i), texel_row(*other, i));
    expect_same(patch_row(*reseeded, i), patch_row(*other, i));
    changed += texel_row(*tracer, i).direct_over_pi != texel_row(*other, i).direct_over_pi;
  }
  EXPECT_GT(changed, 50);  // of 95: few texels meet the same rays by chance
}

TYPED_TEST(EveryTracer, ReplayAddsUpToTheRow) {
  const Surface surface = white_noise_surface(32, 32, 0.2);
  const auto tracer = TypeParam::make(surface, 32);
  for (const uint32_t texel : {0u, 500u, 1023u}) {
    const Row row = texel_row(*tracer, texel);
    double uniform = 0, direct = 0, hit = 0;
    for (const RayRecord& record : tracer->replay_texel(texel)) {
      (record.hit ? hit : direct) += record.cosine_weight;
      if (!record.hit) uniform += record.uniform_weight;
      EXPECT_NEAR(glm::length(record.direction), 1, 1e-6);  // of floats
      EXPECT_LT(record.facet, facet_count(surface));
    }
    EXPECT_NEAR(uniform, row.visible_fraction, TypeParam::kReplay);
    EXPECT_NEAR(direct, row.direct_over_pi, TypeParam::kReplay);
    EXPECT_NEAR(direct + hit, 1, TypeParam::kReplay);
  }
}

TYPED_TEST(EveryTracer, LinksDoNotChangeTheSky) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen, Edge::kGround}) {
    const Surface surface = white_noise_surface(33, 30, 0.1, edge);
    const auto tracer = TypeParam::make(surface, 16);
    for (uint32_t i = 0; i < surface.texel_count(); ++i) {
      const Row with = texel_row(*tracer, i, true), without = texel_row(*tracer, i, false);
      EXPECT_TRUE(without.links.empty());
      EXPECT_NEAR(with.visible_fraction, without.visible_fraction, TypeParam::kLinksOnSky);
      EXPECT_NEAR(with.direct_over_pi, without.direct_over_pi, TypeParam::kLinksOnSky);
    }
  }
}

// A map shifted round by some texels is the same endless surface.
TYPED_TEST(EveryTracer, NoSeam) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 40, 40, 0.3);
  Surface shifted = surface;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x) {
      shifted.heights_m((x + 19) % 40, (y + 23) % 40) = surface.heights_m(x, y);
      shifted.normals((x + 19) % 40, (y + 23) % 40) = surface.normals(x, y);
    }
  const auto tracer = TypeParam::make(surface, TypeParam::kMany),
             other = TypeParam::make(shifted, TypeParam::kMany);
  for (uint32_t x = 0; x < 40; ++x) {  // of row 0, on the seam
    const Row row = texel_row(*tracer, x, false), moved = texel_row(*other, 23 * 40 + (x + 19) % 40, false);
    EXPECT_NEAR(row.visible_fraction, moved.visible_fraction, TypeParam::seam()) << x;
    EXPECT_NEAR(row.direct_over_pi, moved.direct_over_pi, TypeParam::seam()) << x;
  }
}

TYPED_TEST(EveryTracer, MaxDistanceTurnsFarHitsIntoSky) {
  const Surface surface = synthetic_surface(SyntheticKind::kCanyon, 64, 64, 0.5);
  const uint32_t middle_of_floor = 32 * 64 + 32;
  // Walls of 45° above both sides leave half of the hemisphere, and the nearest is 16 texels = ¼ m away.
  EXPECT_LT(texel_row(*TypeParam::make(surface, 1024), middle_of_floor).visible_fraction, 0.6);
  const Row near = texel_row(*TypeParam::make(surface, 1024, 0, 0.1), middle_of_floor);
  EXPECT_NEAR(near.visible_fraction, 1, 1e-6);  // float sums of slices
}

TYPED_TEST(EveryTracer, OpenEdgesLetLightInFromTheSide) {
  const Surface wrapped = synthetic_surface(SyntheticKind::kStep, 64, 64, 0.5);
  const Surface open = synthetic_surface(SyntheticKind::kStep, 64, 64, 0.5, {}, Edge::kOpen);
  const uint32_t last_column = 32 * 64 + 62;
  EXPECT_GT(texel_row(*TypeParam::make(open, 1024), last_column).visible_fraction,
            texel_row(*TypeParam::make(wrapped, 1024), last_column).visible_fraction + 0.3);
}

TYPED_TEST(EveryTracer, NormalsFromAMapTiltTheHemisphere) {
  Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8);
  const double tilt = kPi / 6;
  for (auto& normal : surface.normals.values) normal = glm::vec3(std::sin(tilt), 0, std::cos(tilt));
  const Row row = texel_row(*TypeParam::make(surface, TypeParam::kMany), 9);
  // A hemisphere tilted by t over flat ground: 1 − t/π of its directions and (1 + cos t)/2 of its cosine are
  // sky.
  EXPECT_NEAR(row.visible_fraction, 1 - tilt / kPi, TypeParam::sampling());
  EXPECT_NEAR(row.direct_over_pi, (1 + std::cos(tilt)) / 2, TypeParam::sampling());
}

TYPED_TEST(EveryTracer, ExtremesStayFinite) {
  for (const double amplitude : {0.0, 1e-6, 1e3}) {
    for (const Edge edge : {Edge::kWrap, Edge::kOpen, Edge::kGround}) {
      for (const auto& [width, height] : {std::pair{1, 1}, {1, 37}, {37, 1}, {2, 2}, {33, 17}}) {
        if (edge != Edge::kWrap && (width < 2 || height < 2)) continue;
        const Surface surface = white_noise_surface(width, height, amplitude, edge);
        const auto tracer = TypeParam::make(surface, 16);
        for (uint32_t i = 0; i < std::min(surface.texel_count(), tracer->patch_set().count); ++i) {
          expect_valid(texel_row(*tracer, i), *tracer);
          expect_valid(patch_row(*tracer, i), *tracer);
        }
      }
    }
  }
}

TYPED_TEST(EveryNodeTracer, FacetsNeverSeeThemselves) {
  for (const double amplitude : {1e-6, 0.1, 1e3}) {
    const Surface surface = white_noise_surface(24, 24, amplitude);
    const auto tracer = TypeParam::make(surface, 64);
    const PatchSet& patches = tracer->patch_set();
    for (uint32_t patch = 0; patch < patches.count; ++patch)
      for (const FormFactor& link : patch_row(*tracer, patch).links)
        EXPECT_NE(facet_node(patches, link.patch).facet, facet_node(patches, patch).facet);
  }
}

// No node may lose rays through the ground: the nodes' light adds up to the light through the opening.
TYPED_TEST(EveryNodeTracer, NodeLightAddsUpToTheOpening) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 64, 64, 0.1);
  const auto tracer = TypeParam::make(surface, 64);
  const PatchSet& patches = tracer->patch_set();
  std::vector<double> light;
  double variance = 0;  // of the sum, at most: rays are stratified, and nodes have 8 or more
  for (uint32_t patch = 0; patch < patches.count; ++patch) {
    light.push_back(patch_row(*tracer, patch, false).direct_over_pi);
    const double share = patch_area_texels(surface, patches, patch) / (0.5 * facet_count(surface));
    variance += share * share * light.back() * (1 - light.back()) / 8;
  }
  // The rule over the nodes misses 0.117 % of the light along the folds of this map, whose slopes turn by 5°
  // a texel.
  EXPECT_NEAR(sum_over_opening(surface, patches, std::span<const double>(light)), 1,
              0.0012 + 3 * std::sqrt(variance));
}

}  // namespace
}  // namespace hemibake
