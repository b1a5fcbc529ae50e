// Draws a random sample of texels and estimates the mean of all of them from it. Source: Cochran, "Sampling
// Techniques", 3rd ed. 1977, chapters 5 (strata) and 10 (two stages: texels, and paths within a texel).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reference/path_tracer.h"

namespace hemibake {

struct TexelSample {
  struct Stratum {
    size_t population;  // texels it stands for
    size_t count;       // sampled texels: consecutive in `texels`
  };
  std::vector<uint32_t> texels;
  std::vector<Stratum> strata;
};

// Cuts texels into strata of consecutive ones and draws two different texels at random from each. Takes all
// of them, as one stratum, if there are no more than wanted. population: texels in the order of the cut, not
// empty. wanted: drawn in all, about; 2...
TexelSample sample_texels(std::span<const uint32_t> population, size_t wanted, uint64_t seed);

// Appends the strata of `more`.
void append_sample(TexelSample& sample, const TexelSample& more);

// Estimates the mean over the population. The interval holds the spread between texels (none if all were
// taken) and the noise within; its Student factor takes Satterthwaite's degrees of freedom, those of the
// measurements if all texels were taken.
// values, variances: of the measurement of every sampled texel. confidence: in (0, 1).
RefereeInterval mean_from_sample(const TexelSample& sample, std::span<const double> values,
                                 std::span<const double> variances, double confidence);

// Returns the mean of values weighted by the strata, as mean_from_sample does.
// values: one per sampled texel.
double weighted_mean(const TexelSample& sample, std::span<const double> values);

// Estimates the mean over a domain: some of the texels, which the strata know nothing of (Cochran, 5A.14).
// The interval is that of a ratio of two estimates, to first order. inside: per sampled texel, one or more of
// them true. values, variances: as of mean_from_sample.
RefereeInterval mean_of_domain(const TexelSample& sample, const std::vector<bool>& inside,
                               std::span<const double> values, std::span<const double> variances,
                               double confidence);
// Returns the mean of values over a domain, weighted by the strata.
double weighted_mean(const TexelSample& sample, const std::vector<bool>& inside,
                     std::span<const double> values);

}  // namespace hemibake
