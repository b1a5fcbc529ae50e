// A random sample of texels and the mean of all of them estimated from it. Source: Cochran, "Sampling
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

// Cuts `population` in the order given into strata of consecutive texels and draws two different ones from
// each at random, about `wanted` in all; everything, as one stratum, where it has no more than that. Not
// empty; wanted ≥ 2.
TexelSample sample_texels(std::span<const uint32_t> population, size_t wanted, uint64_t seed);

// Appends the strata of `more`.
void append_sample(TexelSample& sample, const TexelSample& more);

// The mean over the whole population from one measured value per sampled texel, each with the variance of its
// measurement. The interval holds the spread between texels (none where all were taken) and the noise within;
// its Student factor takes Satterthwaite's degrees of freedom, or those of the measurements where all texels
// were taken.
RefereeInterval mean_from_sample(const TexelSample& sample, std::span<const double> values,
                                 std::span<const double> variances, double confidence);

// The mean of a sampled quantity itself, weighted like mean_from_sample.
double weighted_mean(const TexelSample& sample, std::span<const double> values);

// The same two of some of the texels only, which the strata know nothing of: a domain (Cochran, 5A.14).
// inside: per sampled texel, one or more of them true. The interval is that of a ratio of two estimates, to
// first order.
RefereeInterval mean_of_domain(const TexelSample& sample, const std::vector<bool>& inside,
                               std::span<const double> values, std::span<const double> variances,
                               double confidence);
double weighted_mean(const TexelSample& sample, const std::vector<bool>& inside,
                     std::span<const double> values);

}  // namespace hemibake
