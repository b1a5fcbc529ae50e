#include "curves/curves.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "curves/check_curves.h"

namespace hemibake {
namespace {

Bake make_bake(const std::vector<float>& ao, const std::vector<std::vector<float>>& irradiance) {
  Bake bake;
  bake.width = static_cast<int>(ao.size());
  bake.height = 1;
  bake.visible_fraction = Grid<float>(bake.width, 1);
  bake.visible_fraction.values = ao;
  for (const std::vector<float>& values : irradiance) {
    bake.irradiance.emplace_back(bake.width, 1);
    bake.irradiance.back().values = values;
  }
  return bake;
}

TEST(Curves, BinEdgesBelongToTheBinAboveAndOneToTheLast) {
  const Bake bake = make_bake({0, 0.2499999F, 0.25F, 0.75F, 0.9999F, 1}, {{0, 1, 2, 3, 3, 3}});
  const Curves curves = make_curves(bake, 4);
  ASSERT_EQ(curves.bins.size(), 4U);
  const std::vector<double> counts{2, 1, 0, 3};
  for (size_t j = 0; j < 4; ++j) {
    EXPECT_EQ(curves.bins[j].count, counts[j]) << "bin " << j;
    EXPECT_DOUBLE_EQ(curves.bins[j].low, 0.25 * static_cast<double>(j));
    EXPECT_DOUBLE_EQ(bin_center(curves.bins[j]), 0.25 * static_cast<double>(j) + 0.125);
  }
}

TEST(Curves, MeanAndSpreadOfEveryBounce) {
  const Bake bake = make_bake({0.1F, 0.2F, 0.9F}, {{1, 2, 3}, {0.5F, 0.5F, 0.25F}});
  const Curves curves = make_curves(bake, 2);
  EXPECT_EQ(curves.bounce_count, 2);
  EXPECT_NEAR(curves.bins[0].mean, 0.15, 1e-8);
  EXPECT_DOUBLE_EQ(curves.bins[0].bounces[0].mean, 1.5);
  EXPECT_DOUBLE_EQ(curves.bins[0].bounces[0].stddev, 0.5);
  EXPECT_DOUBLE_EQ(curves.bins[0].bounces[1].mean, 0.5);
  EXPECT_DOUBLE_EQ(curves.bins[0].bounces[1].stddev, 0);
  EXPECT_DOUBLE_EQ(curves.bins[1].bounces[1].mean, 0.25);
}

TEST(Curves, TexelsOfAllBinsAddUp) {
  std::vector<float> ao, irradiance;
  for (int i = 0; i < 1000; ++i) {
    ao.push_back(static_cast<float>(i) / 999.0F);
    irradiance.push_back(static_cast<float>(i % 7));
  }
  const Curves curves = make_curves(make_bake(ao, {irradiance}), 13);
  double count = 0, sum = 0;
  for (const CurveBin& bin : curves.bins) {
    count += bin.count;
    sum += bin.count * bin.bounces[0].mean;
  }
  EXPECT_EQ(count, 1000);
  EXPECT_NEAR(sum, 142 * 21 + 15, 1e-9);  // 142 whole rounds of 0..6 and 0..5 once
}

TEST(Curves, PooledSetsKeepTheirBinsAndTheCurvesTheyShare) {
  const Curves one = make_curves(make_bake({0.1F, 0.9F}, {{1, 2}, {0.5F, 0.25F}}), 2);
  Curves other = make_curves(make_bake({0.3F, 0.7F}, {{1, 2}}), 4);
  other.has_counts = false;
  const Curves pooled = pool_curves(std::vector<Curves>{one, other});
  EXPECT_EQ(pooled.bins.size(), 6U);
  EXPECT_EQ(pooled.bounce_count, 1);
  EXPECT_EQ(pooled.bins[0].bounces.size(), 1U);
  EXPECT_FALSE(pooled.has_counts);
}

// A bin whose last two bounces are nearly equal: their ratio alone would bring 9.5 π·0.1 more.
TEST(Curves, TailBringsNoMoreLightThanThereIs) {
  CurveBin slow;
  for (const double over_pi : {0.1, 0.1, 0.1, 0.095}) slow.bounces.push_back({over_pi * kPi, 0});
  EXPECT_NEAR(total_over_pi(slow, 1), 1, 1e-15);
  // Ratio at which 0.095 (r + r² + …) is the 0.605 left: 0.605/0.7. Some roundings of numbers below 1.
  const double ratio = 0.605 / 0.7, power = 0.125;
  EXPECT_NEAR(total_over_pi(slow, 0.5),
              0.1 + 0.05 + 0.025 + 0.095 * power + 0.095 * power * 0.5 * ratio / (1 - 0.5 * ratio), 1e-15);
  EXPECT_EQ(total_over_pi(slow, 0), 0.1);
  for (BounceStatistics& bounce : slow.bounces) bounce.mean *= 3;
  EXPECT_NEAR(total_over_pi(slow, 1), 3 * 0.395, 1e-15) << "more than π already: no tail";
}

TEST(Curves, TailOfABinWithTimeToSpareIsGeometric) {
  CurveBin bin;
  for (const double mean : {1.0, 0.5, 0.25}) bin.bounces.push_back({mean, 0});
  EXPECT_DOUBLE_EQ(total_over_pi(bin, 1), 2 / kPi);
  EXPECT_DOUBLE_EQ(total_over_pi(bin, 0.5), 1 / (1 - 0.25) / kPi);
  bin.bounces.pop_back();
  EXPECT_DOUBLE_EQ(total_over_pi(bin, 1), 1.5 / kPi) << "two bounces tell no ratio";
}

TEST(Curves, OverVisibilityTexelsAreSortedByDirectLightOverPi) {
  const float pi = static_cast<float>(kPi);
  Bake bake = make_bake({}, {{0, 0.3F * pi, 0.3F * pi, pi, 1.0077F * pi}, {0, 1, 2, 0, 0}});
  bake.width = 5;
  bake.visible_fraction = {};
  for (const bool has_plane : {false, true}) {
    const Curves curves = make_curves(bake, 4, CurveIndex::kVisibility);
    EXPECT_EQ(curves.index, CurveIndex::kVisibility) << has_plane;
    const std::vector<double> counts{1, 2, 0, 2};
    for (size_t j = 0; j < 4; ++j) EXPECT_EQ(curves.bins[j].count, counts[j]) << "bin " << j;
    EXPECT_NEAR(curves.bins[1].mean, 0.3, 1e-7);
    EXPECT_NEAR(bin_visibility(curves.bins[1]), 0.3, 1e-7);
    EXPECT_DOUBLE_EQ(curves.bins[1].bounces[1].mean, 1.5);
    EXPECT_LE(curves.bins[3].mean, 1) << "rays of 2018 give V up to 1.0078";
    bake.visibility = Grid<float>(5, 1);
    bake.visibility.values = {0, 0.3F, 0.3F, 1, 1};
  }
  EXPECT_THROW(make_curves(bake, 4, CurveIndex::kAo), InputError);
  Curves over_ao;
  const Curves over_v = make_curves(bake, 4, CurveIndex::kVisibility);
  EXPECT_THROW(pool_curves(std::vector<Curves>{over_v, over_ao}), InputError);
}

// In a pit of a spherical cap every texel has V = C, and so has the chance of escape: m = C. Any histogram of
// the same texels gives the same m, since the spread within bins is part of ⟨V²⟩.
TEST(Curves, MeanEscapeIsThatOfTheTexels) {
  const float pi = static_cast<float>(kPi);
  EXPECT_NEAR(*mean_escape(make_curves(make_bake({0.2F, 0.9F}, {{0.4F * pi, 0.4F * pi}}), 10)), 0.4, 1e-6);
  const Bake bake = make_bake({0.1F, 0.2F, 0.5F, 0.9F}, {{0.1F * pi, 0.6F * pi, 0.7F * pi, pi}});
  const double mean = 2.4 / 4, squares = (0.01 + 0.36 + 0.49 + 1) / 4;
  for (const int bins : {1, 2, 7, 100})
    for (const CurveIndex index : {CurveIndex::kAo, CurveIndex::kVisibility})
      EXPECT_NEAR(*mean_escape(make_curves(bake, bins, index)), (mean - squares) / (1 - mean), 1e-6);
  EXPECT_EQ(*mean_escape(make_curves(make_bake({1, 1}, {{pi, pi}}), 10)), 1) << "flat ground";
  EXPECT_EQ(*mean_escape(make_curves(make_bake({0, 0}, {{0, 0}}), 10)), 0);
}

TEST(Curves, ChecksOfCurvesOverVisibilityHoldDirectLightToItsBin) {
  const float pi = static_cast<float>(kPi);
  // V = 0.9 at α = 0.3 is out of α's bounds, and right for curves over V.
  const Bake bake = make_bake({0.3F, 0.35F}, {{0.9F * pi, 0.92F * pi}});
  EXPECT_FALSE(all_passed(check_curves(make_curves(bake, 10), 1e-5, false)));
  Curves curves = make_curves(bake, 10, CurveIndex::kVisibility);
  EXPECT_TRUE(all_passed(check_curves(curves, 1e-5, false)));
  curves.bins[9].bounces[0].mean = 0.5 * kPi;
  EXPECT_FALSE(all_passed(check_curves(curves, 1e-5, false)));
}

TEST(Curves, UnusableTexelsAreNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(make_curves(make_bake({0.5F, nan}, {{1, 1}}), 10), InputError);
  EXPECT_THROW(make_curves(make_bake({0.5F, 1.1F}, {{1, 1}}), 10), InputError);
  EXPECT_THROW(make_curves(make_bake({0.5F, 0.5F}, {{1, -1}}), 10), InputError);
  EXPECT_THROW(make_curves(make_bake({0.5F}, {}), 10), InputError);
  EXPECT_THROW(make_curves(Bake{}, 10), InputError);
  try {
    make_curves(make_bake({0.5F, 0.25F}, {{1, nan}}), 10);
    FAIL() << "a NaN passed";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "irradiance.00 at texel (1, 0) is nan, expected a finite number from 0");
  }
}

}  // namespace
}  // namespace hemibake
