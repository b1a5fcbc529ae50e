#include "sampling/directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

TEST(LowDiscrepancy, RadicalInverseMirrorsDigits) {
  EXPECT_DOUBLE_EQ(radical_inverse(2, 0), 0);
  EXPECT_DOUBLE_EQ(radical_inverse(2, 1), 0.5);
  EXPECT_DOUBLE_EQ(radical_inverse(2, 6), 0.375);              // 110 → .011
  EXPECT_DOUBLE_EQ(radical_inverse(3, 5), 2.0 / 3 + 1.0 / 9);  // 12 → .21
}

TEST(LowDiscrepancy, ShiftStaysInTheUnitInterval) {
  EXPECT_DOUBLE_EQ(cranley_patterson_rotate(0.75, 0.5), 0.25);
  EXPECT_DOUBLE_EQ(cranley_patterson_rotate(0.5, 0.5), 0);
}

TEST(LowDiscrepancy, HashSeparatesSeedsStreamsAndIndices) {
  std::set<uint64_t> seen;
  for (uint64_t seed = 0; seed < 10; ++seed)
    for (uint64_t stream = 0; stream < 10; ++stream)
      for (uint64_t index = 0; index < 10; ++index) seen.insert(mix_bits(seed, stream, index));
  EXPECT_EQ(seen.size(), 1000u);
}

TEST(LowDiscrepancy, HashedNumbersAreEven) {
  double sum = 0, squares = 0;
  constexpr int kCount = 100000;
  for (uint64_t i = 0; i < kCount; ++i) {
    const double u = unit_interval(mix_bits(3, 1, i));
    sum += u;
    squares += u * u;
  }
  // Standard errors of the mean (1/√12n) and of the mean square (√(4/45)/√n), four of each.
  EXPECT_NEAR(sum / kCount, 0.5, 4 / std::sqrt(12.0 * kCount));
  EXPECT_NEAR(squares / kCount, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / kCount));
}

TEST(Directions, WeightsMakeOpenGroundWhole) {
  for (const DirectionSet set : {DirectionSet::kUniform, DirectionSet::kCosine}) {
    for (const int count : {1, 2, 7, 256, 1000}) {
      for (const double cone : {180.0, 179.0, 60.0}) {
        double uniform = 0, cosine = 0;
        for (const auto& direction : make_directions(set, count, cone)) {
          EXPECT_NEAR(glm::length(direction.local), 1, 1e-6);
          EXPECT_GT(direction.local.z, 0);
          uniform += direction.uniform_weight;
          cosine += direction.cosine_weight;
        }
        EXPECT_NEAR(uniform, 1, 1e-12);
        EXPECT_NEAR(cosine, 1, 1e-12);
      }
    }
  }
}

// The midpoint rule in u₁ makes the moments of the cosine what they are on the hemisphere.
TEST(Directions, MomentsOfTheCosine) {
  constexpr int kCount = 1024;
  double uniform_mean = 0, cosine_mean = 0;
  for (const auto& d : make_directions(DirectionSet::kUniform, kCount, 180))
    uniform_mean += d.uniform_weight * static_cast<double>(d.local.z);
  for (const auto& d : make_directions(DirectionSet::kCosine, kCount, 180))
    cosine_mean += d.cosine_weight * static_cast<double>(d.local.z);
  EXPECT_NEAR(uniform_mean, 0.5, 1e-6);
  EXPECT_NEAR(cosine_mean, 2.0 / 3, 1.0 / kCount);
}

TEST(Directions, ConeLimitsTheAngle) {
  for (const DirectionSet set : {DirectionSet::kUniform, DirectionSet::kCosine})
    for (const auto& d : make_directions(set, 256, 90)) EXPECT_GT(d.local.z, std::cos(0.7854) - 1e-4);
}

}  // namespace
}  // namespace hemibake
