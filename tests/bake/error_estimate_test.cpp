#include "bake/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/constants.h"
#include "core/statistics.h"
#include "reference/path_tracer.h"
#include "support/maps.h"
#include "tracers/embree/embree.h"

namespace hemibake {
namespace {

struct Baked {
  LightTransport seen;
  Bounces bounces;
  ErrorEstimate errors;
};

Baked bake(const Surface& surface, int rays, PatchKind patches = PatchKind::kFacets) {
  RayOptions options;
  options.rays = rays;
  options.patch_kind = patches;
  const auto tracer = make_embree_tracer(surface, options);
  Baked baked{trace_surface(*tracer, KeptLinks::kAll), {}, {}};
  baked.bounces = bounce_light(baked.seen, {});
  baked.errors = estimate_errors(*tracer->reseeded(99), baked.seen, baked.bounces);
  return baked;
}

double rms_difference(const Grid<float>& a, const Grid<float>& b) {
  Moments squares;
  for (size_t i = 0; i < a.size(); ++i)
    squares.add(std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2));
  return std::sqrt(squares.mean);
}

double mean_over_pi(const Grid<float>& plane) { return mean(std::span<const float>(plane.values)) / kPi; }

TEST(ErrorEstimate, FlatGroundHasNone) {
  const Baked flat = bake(synthetic_surface(SyntheticKind::kFlat, 16, 16), 64);
  EXPECT_EQ(flat.errors.ao_rays, 0);
  EXPECT_EQ(flat.errors.direct_rays, 0);
  EXPECT_EQ(flat.errors.first_rays, 0);
  EXPECT_EQ(flat.errors.first_patches, 0);
  EXPECT_EQ(flat.errors.total_bounces, 0);
  EXPECT_EQ(flat.errors.curve_direct, 0);
}

// The noise of a texel against what many more rays say, a sixth as noisy: all texels of the map or nearly,
// so that a fifth is room for the spread of the squares.
TEST(ErrorEstimate, NoiseOfTexelsIsWhatMoreRaysSay) {
  for (const SyntheticKind kind : {SyntheticKind::kNoise, SyntheticKind::kBricks}) {
    const Surface surface = synthetic_surface(kind, 40, 40, 0.1);
    const Baked coarse = bake(surface, 64), fine = bake(surface, 1024);
    const double ao = rms_difference(coarse.seen.visible_fraction, fine.seen.visible_fraction);
    const double direct = rms_difference(coarse.seen.direct_over_pi, fine.seen.direct_over_pi);
    EXPECT_NEAR(coarse.errors.ao_rays / ao, 1, 0.2);
    EXPECT_NEAR(coarse.errors.direct_rays / direct, 1, 0.2);
    const double first = rms_difference(coarse.bounces.irradiance[1], fine.bounces.irradiance[1]) / kPi;
    // With the noise of the nodes' light; where few rays meet the same node twice their variances add up to
    // more than told: as a factor 1.3.
    EXPECT_NEAR(coarse.errors.first_rays / first, 1, 0.3);
  }
}

// Against the referee on every texel: the error of a texel's E₁ within a factor 2, and that of the mean,
// which the linear elements leave, never more than twice what is told.
TEST(ErrorEstimate, AgainstTheReferee) {
  for (const SyntheticKind kind : {SyntheticKind::kBricks, SyntheticKind::kShapes}) {
    const Surface surface = synthetic_surface(kind, 32, 32);
    const Baked baked = bake(surface, 512);
    std::vector<uint32_t> texels(surface.texel_count());
    std::iota(texels.begin(), texels.end(), 0u);
    RefereeOptions options;
    options.paths = 1024;
    options.bounces = 1;
    const RefereeEstimates truth = referee_texels(surface, texels, options);
    double first = 0, variance = 0, squared = 0;
    for (size_t i = 0; i < texels.size(); ++i) {
      const double difference =
          static_cast<double>(baked.bounces.irradiance[1][i]) / kPi - truth.mean[truth.index(i, 1)];
      squared +=
          (difference * difference - truth.variance[truth.index(i, 1)]) / static_cast<double>(texels.size());
      first += truth.mean[truth.index(i, 1)] / static_cast<double>(texels.size());
      variance += truth.variance[truth.index(i, 1)] / std::pow(static_cast<double>(texels.size()), 2);
    }
    EXPECT_LT(std::abs(std::log2(baked.errors.first_rays / std::sqrt(squared))), 1);
    const double actual = std::abs(mean_over_pi(baked.bounces.irradiance[1]) - first);
    const double noise = 3 * std::hypot(std::sqrt(variance), baked.errors.mean_first_rays);
    EXPECT_LT(actual, 2 * baked.errors.first_patches + noise);
    // Told from the same rays, it has their noise.
    EXPECT_LT(baked.errors.first_patches, 0.005 * first + noise);
  }
}

// Few rays move texels between bins: the curve of noisy AO against the same texels in the bins of good AO.
TEST(ErrorEstimate, CurveIsBiasedAsMuchAsSaid) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 96, 96, 0.2);
  const Baked coarse = bake(surface, 64), fine = bake(surface, 512);
  constexpr size_t kBins = 25;
  const auto curve = [&](const Baked& baked) {
    std::vector<Moments> bins(kBins);
    for (size_t i = 0; i < surface.texel_count(); ++i)
      bins[std::min(kBins - 1, static_cast<size_t>(kBins * baked.seen.visible_fraction[i]))].add(
          static_cast<double>(baked.seen.direct_over_pi[i]));
    return bins;
  };
  const auto noisy = curve(coarse), good = curve(fine);
  double sum = 0, count = 0;
  for (size_t b = 0; b < kBins; ++b) {
    if (noisy[b].count < 50 || good[b].count < 50) continue;
    sum += static_cast<double>(noisy[b].count) * std::pow(noisy[b].mean - good[b].mean, 2);
    count += static_cast<double>(noisy[b].count);
  }
  const double actual = std::sqrt(sum / count);
  EXPECT_GT(coarse.errors.curve_direct, actual / 2);
  EXPECT_LT(coarse.errors.curve_direct, actual * 2);
  EXPECT_LT(fine.errors.curve_direct, coarse.errors.curve_direct / 4);
}

TEST(ErrorEstimate, TexelsAsPatchesAndTinyMaps) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {33, 2}}) {
    const Surface surface = white_noise_surface(width, height, 0.1);
    for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels}) {
      const ErrorEstimate e = bake(surface, 16, patches).errors;
      for (const double value :
           {e.ao_rays, e.direct_rays, e.first_rays, e.mean_first_rays, e.first_patches, e.half_patches,
            e.total_bounces, e.half_bounces, e.far_horizon, e.curve_direct, e.curve_first}) {
        EXPECT_GE(value, 0);
        EXPECT_LE(value, 1);
      }
    }
  }
}

}  // namespace
}  // namespace hemibake
