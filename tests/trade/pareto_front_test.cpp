#include "trade/pareto_front.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

TEST(ParetoFront, KeepsWhatNoOtherBeats) {
  const std::vector<CostAndError> runs{{1, 0.5}, {2, 0.6},   {2, 0.3}, {3, 0.3},
                                       {1, 0.5}, {0.5, 0.9}, {9, 0.1}};
  EXPECT_THAT(pareto_front(runs), testing::ElementsAre(5, 0, 2, 6));
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(ParetoFront, NoMemberIsBeatenAndEveryOtherIs) {
  std::vector<CostAndError> runs;
  for (uint64_t i = 0; i < 300; ++i)
    runs.push_back({unit_interval(mix_bits(1, 0, i)), unit_interval(mix_bits(1, 1, i))});
  const std::vector<size_t> front = pareto_front(runs);
  for (size_t i = 0; i < runs.size(); ++i) {
    const bool beaten = std::ranges::any_of(runs, [&](const CostAndError& other) {
      return other.cpu_seconds <= runs[i].cpu_seconds && other.error <= runs[i].error &&
             (other.cpu_seconds < runs[i].cpu_seconds || other.error < runs[i].error);
    });
    EXPECT_EQ(std::ranges::find(front, i) == front.end(), beaten) << i;
  }
}

TEST(PowerLaw, IsRecovered) {
  std::vector<double> x, y;
  for (const double at : {4.0, 16.0, 64.0, 256.0}) {
    x.push_back(at);
    y.push_back(0.3 * std::pow(at, -0.75));
  }
  PowerLaw law = fit_power_law(x, y);
  EXPECT_NEAR(law.slope, -0.75, 1e-12);
  EXPECT_NEAR(law.slope_error, 0, 1e-7);
  // A point off by a factor e^h at one end: the slope moves by h·(u − ū)/Σ(u − ū)², and has an error.
  y[3] *= std::exp(0.1);
  law = fit_power_law(x, y);
  const double step = std::log(4);
  EXPECT_NEAR(law.slope, -0.75 + 0.1 * 1.5 * step / (5 * step * step), 1e-12);
  EXPECT_GT(law.slope_error, 0);
}

TEST(PowerLaw, NeedsTwoPoints) {
  EXPECT_LT(fit_power_law(std::vector<double>{1}, std::vector<double>{1}).points, 2u);
  EXPECT_LT(fit_power_law(std::vector<double>{1, 2}, std::vector<double>{1, 0}).points, 2u);
  EXPECT_LT(fit_power_law(std::vector<double>{2, 2}, std::vector<double>{1, 3}).points, 2u);
}

}  // namespace
}  // namespace hemibake
