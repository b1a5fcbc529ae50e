#include "sampling/warp.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <vector>

#include "core/constants.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

constexpr double kNarrowCone = 0.5;  // cosine of 60°

glm::dvec2 random_point(uint64_t i) { return {unit_interval(mix_bits(1, 0, i)), unit_interval(mix_bits(1, 1, i))}; }

TEST(Warp, CornersOfTheSquare) {
  EXPECT_DOUBLE_EQ(sample_uniform_hemisphere({0, 0}).z, 1);
  EXPECT_DOUBLE_EQ(sample_cosine_hemisphere({0, 0}).z, 1);
  EXPECT_DOUBLE_EQ(sample_uniform_hemisphere({1, 0}).x, 1);
  EXPECT_DOUBLE_EQ(sample_cosine_hemisphere({1, 0}).x, 1);
  EXPECT_NEAR(sample_uniform_hemisphere({1, 0}, kNarrowCone).z, kNarrowCone, 1e-15);
  EXPECT_NEAR(sample_cosine_hemisphere({1, 0}, kNarrowCone).z, kNarrowCone, 1e-15);
  EXPECT_NEAR(sample_uniform_hemisphere({1, 0.25}).y, 1, 1e-15);
  EXPECT_EQ(sample_uniform_triangle({1, 0}), glm::dvec2(0, 0));
  EXPECT_EQ(sample_uniform_triangle({0, 0.7}), glm::dvec2(1, 0));
  EXPECT_EQ(sample_uniform_triangle({1, 1}), glm::dvec2(0, 1));
}

TEST(Warp, InversesGiveTheSquareBack) {
  for (uint64_t i = 0; i < 1000; ++i) {
    const glm::dvec2 u = random_point(i);
    for (const double cos_max : {0.0, kNarrowCone}) {
      const glm::dvec3 uniform = sample_uniform_hemisphere(u, cos_max), cosine = sample_cosine_hemisphere(u, cos_max);
      EXPECT_NEAR(glm::length(uniform), 1, 1e-14);
      EXPECT_NEAR(glm::length(cosine), 1, 1e-14);
      EXPECT_LT(glm::length(invert_uniform_hemisphere(uniform, cos_max) - u), 1e-9);
      EXPECT_LT(glm::length(invert_cosine_hemisphere(cosine, cos_max) - u), 1e-9);
    }
    EXPECT_LT(glm::length(invert_uniform_triangle(sample_uniform_triangle(u)) - u), 1e-9);
  }
}

// χ² over 8 × 8 cells (equal in u by construction of `cell_of`) whose expected share `share` integrates the pdf.
double chi_squared(const std::function<int(glm::dvec2)>& cell_of, const std::vector<double>& share, int samples) {
  std::vector<double> counts(share.size(), 0.0);
  for (int i = 0; i < samples; ++i) ++counts[static_cast<size_t>(cell_of(random_point(static_cast<uint64_t>(i))))];
  double chi2 = 0;
  for (size_t c = 0; c < share.size(); ++c) {
    const double expected = share[c] * samples;
    chi2 += (counts[c] - expected) * (counts[c] - expected) / expected;
  }
  return chi2;
}

// Cells of equal θ and φ; their shares are ∫ pdf sinθ dθ dφ by the midpoint rule.
void expect_density(const std::function<glm::dvec3(glm::dvec2)>& sample, const std::function<double(double)>& pdf,
                    double theta_max) {
  constexpr int kSide = 8, kSteps = 4000, kSamples = 100000;
  std::vector<double> share(kSide * kSide);
  for (int t = 0; t < kSide; ++t) {
    double integral = 0;
    const double step = theta_max / kSide / kSteps;
    for (int s = 0; s < kSteps; ++s) {
      const double theta = t * theta_max / kSide + (s + 0.5) * step;
      integral += pdf(std::cos(theta)) * std::sin(theta) * step;
    }
    for (int p = 0; p < kSide; ++p) share[static_cast<size_t>(t * kSide + p)] = integral * 2 * kPi / kSide;
  }
  const auto cell_of = [&](glm::dvec2 u) {
    const glm::dvec3 d = sample(u);
    const double azimuth = std::atan2(d.y, d.x);
    const int t = std::min(kSide - 1, static_cast<int>(std::acos(d.z) / theta_max * kSide));
    const int p = std::min(kSide - 1, static_cast<int>((azimuth < 0 ? azimuth + 2 * kPi : azimuth) / (2 * kPi) * kSide));
    return t * kSide + p;
  };
  // 99.9 % quantile of χ² with 63 degrees of freedom.
  EXPECT_LT(chi_squared(cell_of, share, kSamples), 103.4);
}

TEST(Warp, DensitiesAreWhatThePdfSays) {
  for (const double cos_max : {0.0, kNarrowCone}) {
    const double theta_max = std::acos(cos_max);
    expect_density([&](glm::dvec2 u) { return sample_uniform_hemisphere(u, cos_max); },
                   [&](double) { return uniform_hemisphere_pdf(cos_max); }, theta_max);
    expect_density([&](glm::dvec2 u) { return sample_cosine_hemisphere(u, cos_max); },
                   [&](double cos_theta) { return cosine_hemisphere_pdf(cos_theta, cos_max); }, theta_max);
  }
}

TEST(Warp, TrianglesAreFilledEvenly) {
  // 16 equal triangles: the barycentric coordinates cut at quarters.
  const auto cell_of = [](glm::dvec2 u) {
    const glm::dvec2 b = sample_uniform_triangle(u);
    const int i = std::min(3, static_cast<int>(4 * b.x)), j = std::min(3, static_cast<int>(4 * b.y));
    const bool upper = 4 * b.x - i + 4 * b.y - j > 1;
    return 8 * j + 2 * i + (upper ? 1 : 0);
  };
  std::vector<double> share;
  std::vector<int> index(32, 0);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i + j < 4; ++i)
      for (int upper = 0; upper < (i + j < 3 ? 2 : 1); ++upper) {
        index[static_cast<size_t>(8 * j + 2 * i + upper)] = static_cast<int>(share.size());
        share.push_back(uniform_triangle_pdf() / 32);
      }
  ASSERT_EQ(share.size(), 16u);
  // 99.9 % quantile of χ² with 15 degrees of freedom.
  EXPECT_LT(chi_squared([&](glm::dvec2 u) { return index[static_cast<size_t>(cell_of(u))]; }, share, 100000), 37.7);
}

}  // namespace
}  // namespace hemibake
