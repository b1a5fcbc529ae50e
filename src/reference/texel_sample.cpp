#include "reference/texel_sample.h"

#include <algorithm>
#include <cmath>

#include "core/confidence.h"
#include "core/error.h"
#include "core/statistics.h"
#include "reference/random.h"

namespace hemibake {
namespace {

double population_of(const TexelSample& sample) {
  double sum = 0;
  for (const TexelSample::Stratum& stratum : sample.strata) sum += static_cast<double>(stratum.population);
  return sum;
}

// Estimates the share of all texels that are inside.
double domain_share(const TexelSample& sample, const std::vector<bool>& inside) {
  return weighted_mean(sample, std::vector<double>(inside.begin(), inside.end()));
}

}  // namespace

TexelSample sample_texels(std::span<const uint32_t> population, size_t wanted, uint64_t seed) {
  TexelSample sample;
  if (population.size() <= std::max<size_t>(2, wanted)) {
    sample.texels.assign(population.begin(), population.end());
    sample.strata.push_back({population.size(), population.size()});
    return sample;
  }
  constexpr uint64_t kSampleStream = ~uint64_t{1};
  RefereeRandom random(seed, kSampleStream, 0);
  const size_t strata = std::max<size_t>(1, wanted / 2);
  for (size_t k = 0; k < strata; ++k) {
    const size_t begin = population.size() * k / strata, end = population.size() * (k + 1) / strata;
    const auto size = static_cast<uint32_t>(end - begin);
    const uint32_t first = random.below(size);
    const uint32_t second = (first + 1 + random.below(size - 1)) % size;
    sample.texels.push_back(population[begin + first]);
    sample.texels.push_back(population[begin + second]);
    sample.strata.push_back({size, 2});
  }
  return sample;
}

void append_sample(TexelSample& sample, const TexelSample& more) {
  sample.texels.insert(sample.texels.end(), more.texels.begin(), more.texels.end());
  sample.strata.insert(sample.strata.end(), more.strata.begin(), more.strata.end());
}

RefereeInterval mean_from_sample(const TexelSample& sample, std::span<const double> values,
                                 std::span<const double> variances, double confidence) {
  expect_equal(values.size(), sample.texels.size(), "values of the sampled texels");
  expect_equal(variances.size(), sample.texels.size(), "variances of the sampled texels");
  const double population = population_of(sample);
  double mean = 0, variance = 0, satterthwaite = 0;
  size_t next = 0;
  for (const TexelSample::Stratum& stratum : sample.strata) {
    Moments between;
    double within = 0;
    for (size_t i = 0; i < stratum.count; ++i, ++next) {
      between.add(values[next]);
      within += variances[next];
    }
    const double share = static_cast<double>(stratum.population) / population;
    const auto count = static_cast<double>(stratum.count);
    const double taken = count / static_cast<double>(stratum.population);
    mean += share * between.mean;
    // Two stages (Cochran, chapter 10): v = (1 − f) s²/n + f · mean of the measurements' variances / n.
    const double spread = stratum.count > 1 ? between.sum_squared_deviations / (count - 1) : 0;
    const double part = share * share * ((1 - taken) * spread + taken * within / count) / count;
    variance += part;
    satterthwaite += part * part / std::max(1.0, count - 1);
  }
  if (variance == 0) return {mean, 0};
  return {mean, student_quantile(confidence, std::max(1.0, variance * variance / satterthwaite)) *
                    std::sqrt(variance)};
}

double weighted_mean(const TexelSample& sample, std::span<const double> values) {
  const double population = population_of(sample);
  double sum = 0;
  size_t next = 0;
  for (const TexelSample::Stratum& stratum : sample.strata)
    for (size_t i = 0; i < stratum.count; ++i)
      sum += values[next++] * static_cast<double>(stratum.population) / static_cast<double>(stratum.count);
  return sum / population;
}

double weighted_mean(const TexelSample& sample, const std::vector<bool>& inside,
                     std::span<const double> values) {
  std::vector<double> within(values.begin(), values.end());
  for (size_t i = 0; i < within.size(); ++i)
    if (!inside[i]) within[i] = 0;
  return weighted_mean(sample, within) / domain_share(sample, inside);
}

RefereeInterval mean_of_domain(const TexelSample& sample, const std::vector<bool>& inside,
                               std::span<const double> values, std::span<const double> variances,
                               double confidence) {
  expect_equal(inside.size(), sample.texels.size(), "marks of the sampled texels");
  const double mean = weighted_mean(sample, inside, values), share = domain_share(sample, inside);
  std::vector<double> deviations(values.size(), 0.0), noise(values.size(), 0.0);
  for (size_t i = 0; i < values.size(); ++i) {
    if (!inside[i]) continue;
    deviations[i] = (values[i] - mean) / share;
    noise[i] = variances[i] / (share * share);
  }
  return {mean, mean_from_sample(sample, deviations, noise, confidence).half_width};
}

}  // namespace hemibake
