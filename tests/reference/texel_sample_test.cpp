#include "reference/texel_sample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>

#include "reference/random.h"

namespace hemibake {
namespace {

std::vector<uint32_t> first_texels(uint32_t count) {
  std::vector<uint32_t> texels(count);
  std::iota(texels.begin(), texels.end(), 0u);
  return texels;
}

TEST(TexelSample, EveryTexelIsDrawnAtMostOnceAndStrataCoverAll) {
  const TexelSample sample = sample_texels(first_texels(1001), 100, 5);
  EXPECT_EQ(sample.texels.size(), 100u);
  EXPECT_EQ(std::set<uint32_t>(sample.texels.begin(), sample.texels.end()).size(), 100u);
  size_t population = 0;
  for (const auto& stratum : sample.strata) population += stratum.population;
  EXPECT_EQ(population, 1001u);
}

TEST(TexelSample, SmallPopulationsAreTakenWhole) {
  const TexelSample sample = sample_texels(first_texels(30), 100, 5);
  EXPECT_EQ(sample.texels, first_texels(30));
  const std::vector<double> values(30, 0.5), exact(30, 0.0), noisy(30, 0.01);
  EXPECT_EQ(mean_from_sample(sample, values, exact, 0.99).half_width, 0);
  // Noise of 30 measurements of variance 0.01: √(0.01/30) times about 2.76 (29 degrees of freedom).
  EXPECT_NEAR(mean_from_sample(sample, values, noisy, 0.99).half_width, 2.756 * std::sqrt(0.01 / 30), 1e-4);
}

TEST(TexelSample, IntervalsHoldTheMeanAsOftenAsTheySay) {
  // A map with a trend, waves and a few outliers, measured with noise.
  const uint32_t count = 5000;
  std::vector<double> truth(count);
  double mean = 0;
  for (uint32_t i = 0; i < count; ++i) {
    truth[i] = i / 5000.0 + std::sin(i * 0.37) * 0.3 + (i % 97 == 0 ? 2 : 0);
    mean += truth[i] / count;
  }
  int held = 0;
  const int seeds = 1000;
  for (int seed = 0; seed < seeds; ++seed) {
    const TexelSample sample = sample_texels(first_texels(count), 400, static_cast<uint64_t>(seed));
    RefereeRandom random(static_cast<uint64_t>(seed), 9, 9);
    std::vector<double> values, variances(sample.texels.size(), 1.0 / 12);
    for (const uint32_t texel : sample.texels) values.push_back(truth[texel] + random.uniform() - 0.5);
    held += mean_from_sample(sample, values, variances, 0.99).contains(mean);
  }
  // 99 % of 1000, four standard deviations of the count (3.1) either way.
  EXPECT_GE(held, 990 - 13);
  EXPECT_LE(held, 1000);
}

// A third of the texels, in no order the strata know: the interval of their mean.
TEST(TexelSample, IntervalsOfADomainHoldItsMean) {
  const uint32_t count = 5000;
  const auto inside = [](uint32_t i) { return i * 2654435761u % 3 == 0; };
  std::vector<double> truth(count);
  double sum = 0, members = 0;
  for (uint32_t i = 0; i < count; ++i) {
    truth[i] = i / 5000.0 + std::sin(i * 0.37) * 0.3;
    if (inside(i)) sum += truth[i], ++members;
  }
  int held = 0;
  const int seeds = 1000;
  for (int seed = 0; seed < seeds; ++seed) {
    const TexelSample sample = sample_texels(first_texels(count), 600, static_cast<uint64_t>(seed));
    RefereeRandom random(static_cast<uint64_t>(seed), 9, 9);
    std::vector<double> values, variances(sample.texels.size(), 1.0 / 12);
    std::vector<bool> marks;
    for (const uint32_t texel : sample.texels) {
      values.push_back(truth[texel] + random.uniform() - 0.5);
      marks.push_back(inside(texel));
    }
    const RefereeInterval interval = mean_of_domain(sample, marks, values, variances, 0.99);
    EXPECT_DOUBLE_EQ(interval.mean, weighted_mean(sample, marks, values));
    held += interval.contains(sum / members);
  }
  // 99 % of 1000, four standard deviations of the count (3.1) either way.
  EXPECT_GE(held, 990 - 13);
}

// All texels as the domain: the mean of the sample itself.
TEST(TexelSample, TheWholeIsADomain) {
  const TexelSample sample = sample_texels(first_texels(1000), 100, 5);
  std::vector<double> values, variances(100, 0.01);
  for (const uint32_t texel : sample.texels) values.push_back(std::sqrt(texel));
  const RefereeInterval whole = mean_from_sample(sample, values, variances, 0.99);
  const RefereeInterval domain =
      mean_of_domain(sample, std::vector<bool>(100, true), values, variances, 0.99);
  EXPECT_NEAR(domain.mean, whole.mean, 1e-12);
  EXPECT_NEAR(domain.half_width, whole.half_width, 1e-12);
}

}  // namespace
}  // namespace hemibake
