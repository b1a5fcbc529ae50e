#include "reference/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/constants.h"
#include "core/error.h"
#include "reference/path_tracer.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {
namespace {

constexpr int kWidth = 32, kBounces = 8;

Surface make_noise() {
  SyntheticOptions options;
  options.width = options.height = kWidth;
  const SyntheticMap map = synthesize(SyntheticKind::kNoise, options);
  return make_surface(map.heights, 1, map.recommended_amplitude_m, Edge::kWrap);
}

struct Planes {
  Grid<float> ao;
  std::vector<Grid<float>> irradiance;

  operator JudgedLight() const { return {ao, irradiance}; }
};

// Light as right as can be: measured by the path tracer itself, with another seed.
const Planes& right_bake() {
  static const Planes bake = [] {
    const Surface surface = make_noise();
    std::vector<uint32_t> texels(surface.texel_count());
    std::iota(texels.begin(), texels.end(), 0u);
    RefereeOptions options;
    options.paths = 1024;
    options.bounces = kBounces;
    options.totals.clear();
    options.seed = 1234;
    const RefereeEstimates measured = referee_texels(surface, texels, options);
    Planes made;
    made.ao = Grid<float>(kWidth, kWidth);
    for (int b = 0; b <= kBounces; ++b) {
      made.irradiance.emplace_back(kWidth, kWidth);
      for (uint32_t i : texels)
        made.irradiance.back()[i] = static_cast<float>(kPi * measured.mean[measured.index(i, b)]);
    }
    // The bins only need something that orders texels by darkness.
    for (uint32_t i : texels) made.ao[i] = made.irradiance[0][i] / static_cast<float>(kPi);
    return made;
  }();
  return bake;
}

RefereeCheckOptions long_check() {
  RefereeCheckOptions options;
  options.texels = kWidth * kWidth;
  options.paths = 1024;
  options.mean_tolerance = 0.02;
  return options;
}

const RefereeRow& row_of(const std::vector<RefereeRow>& rows, const std::string& quantity) {
  for (const RefereeRow& row : rows)
    if (row.quantity == quantity) return row;
  throw std::logic_error("no row " + quantity);
}

TEST(RefereeCheck, ARightBakePasses) {
  const RefereeCheck check = check_against_referee(make_noise(), right_bake(), long_check());
  EXPECT_EQ(check.texels, static_cast<size_t>(kWidth * kWidth));
  ASSERT_EQ(check.means.size(), 5u);  // E0, E1, E2, total, own sum
  for (const RefereeRow& row : check.means) {
    EXPECT_EQ(row.verdict, RefereeVerdict::kWithin)
        << row.quantity << " " << row.bias << " ± " << row.half_width;
    EXPECT_LT(row.half_width, row.tolerance);
    // The bake's own noise remains: at most √(¼/1024) = 0.016 for a share of independent paths.
    EXPECT_LT(row.rms_difference, 0.02) << row.quantity;
  }
  EXPECT_EQ(check.means.back().quantity, "E0 to E8");
  EXPECT_EQ(worst_verdict(check.means), RefereeVerdict::kWithin);
}

TEST(RefereeCheck, AWrongBounceIsFoundAndNamed) {
  Planes bake = right_bake();
  for (float& value : bake.irradiance[1].values) value *= 1.05f;
  const RefereeCheck check = check_against_referee(make_noise(), bake, long_check());
  const RefereeRow& wrong = row_of(check.means, "E1");
  EXPECT_EQ(wrong.verdict, RefereeVerdict::kOutside);
  EXPECT_NEAR(wrong.bias, 0.05 * wrong.referee_mean, wrong.half_width);
  EXPECT_EQ(row_of(check.means, "E0").verdict, RefereeVerdict::kWithin);
  EXPECT_EQ(row_of(check.means, "E2").verdict, RefereeVerdict::kWithin);
  EXPECT_EQ(worst_verdict(check.means), RefereeVerdict::kOutside);
}

TEST(RefereeCheck, ErrorsThatCancelShowInTheRms) {
  Planes bake = right_bake();
  for (size_t i = 0; i < bake.irradiance[0].size(); ++i) bake.irradiance[0][i] += i % 2 == 0 ? 0.1f : -0.1f;
  const RefereeRow row = row_of(check_against_referee(make_noise(), bake, long_check()).means, "E0");
  EXPECT_EQ(row.verdict, RefereeVerdict::kWithin);
  EXPECT_NEAR(row.rms_difference, 0.1 / kPi, 0.02 * 0.1);
}

// Rays that by chance meet more sky raise α and E₀ of a texel and lower its E₁: no texel is wrong on average,
// and no bin may say so, though bins of the bake's own AO would.
TEST(RefereeCheck, NoiseThatMovesTexelsBetweenBinsIsNoError) {
  Planes bake = right_bake();
  for (size_t i = 0; i < bake.irradiance[0].size(); ++i) {
    const float noise = i % 2 == 0 ? 0.05f : -0.05f;
    bake.ao[i] += noise;
    bake.irradiance[0][i] += noise * static_cast<float>(kPi);
    bake.irradiance[1][i] -= noise * static_cast<float>(kPi);
  }
  for (const RefereeRow& row : check_against_referee(make_noise(), bake, long_check()).bins) {
    // All texels are taken, so the interval leaves out that a bin holds more texels of one sign by chance:
    // 0.05 times the root of their number, four times over.
    const double chance = 4 * 0.05 / std::sqrt(static_cast<double>(row.texels));
    EXPECT_LE(std::abs(row.bias), row.half_width + row.tolerance + chance)
        << row.quantity << " " << row.ao_low;
  }
}

TEST(RefereeCheck, TooFewPathsAreNoProof) {
  RefereeCheckOptions options;
  options.texels = 20;
  options.paths = 128;
  options.mean_tolerance = 1e-5;
  const RefereeCheck check = check_against_referee(make_noise(), right_bake(), options);
  EXPECT_EQ(row_of(check.means, "E1").verdict, RefereeVerdict::kUndecided);
}

TEST(RefereeCheck, BinsStandForAllTheirTexels) {
  RefereeCheckOptions options = long_check();
  options.texels = 300;
  const RefereeCheck check = check_against_referee(make_noise(), right_bake(), options);
  size_t texels = 0;
  for (const RefereeRow& row : check.bins) {
    if (row.quantity == "E0") {
      texels += row.texels;
      // α² ≤ E0/π ≤ α (2 − α) in every texel; the noise of α and of the bake, 0.02 each, averages out or
      // helps.
      EXPECT_GE(row.bake_mean, row.ao_low * row.ao_low - 0.02);
      EXPECT_LE(row.bake_mean, row.ao_high * (2 - row.ao_high) + 0.02);
    }
    EXPECT_NE(row.verdict, RefereeVerdict::kOutside) << row.quantity << " " << row.ao_low;
  }
  // Bins of one texel are left out.
  EXPECT_LE(texels, check.texels);
  EXPECT_GE(texels + 10, check.texels);
  EXPECT_GE(check.texels, 290u);
  EXPECT_LE(check.texels, 330u);
}

TEST(RefereeCheck, RefusesWhatDoesNotFit) {
  const Surface surface = make_noise();
  RefereeCheckOptions options;
  options.bounces = kBounces + 1;
  EXPECT_THROW(check_against_referee(surface, right_bake(), options), InputError);
  options = {};
  options.confidence = 1;
  EXPECT_THROW(check_against_referee(surface, right_bake(), options), InputError);
  Planes bake = right_bake();
  bake.ao = {};
  EXPECT_THROW(check_against_referee(surface, bake, {}), InputError);
}

}  // namespace
}  // namespace hemibake
