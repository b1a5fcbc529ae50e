#include "core/confidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace hemibake {
namespace {

TEST(Confidence, NormalQuantilesAreTheTabulatedOnes) {
  EXPECT_NEAR(normal_quantile(0.6826894921370859), 1, 1e-12);
  EXPECT_NEAR(normal_quantile(0.95), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(0.99), 2.5758293035489004, 1e-12);
  EXPECT_NEAR(normal_quantile(0.999999), 4.891638475699, 1e-9);
}

// Where the cumulative distribution has a closed form: tan(πc/2), c √(2/(1 − c²)), and for four degrees of
// freedom √(q − 4) with q = 4 cos(acos(√a)/3)/√a, a = 1 − c² (Shaw, "Sampling Student's T distribution", J.
// Computational Finance 9, 2006).
TEST(Confidence, StudentQuantilesAreTheClosedForms) {
  for (const double c : {0.5, 0.9, 0.99, 0.9999}) {
    const double a = 1 - c * c, q = 4 * std::cos(std::acos(std::sqrt(a)) / 3) / std::sqrt(a);
    EXPECT_NEAR(student_quantile(c, 1) / std::tan(std::numbers::pi / 2 * c), 1, 1e-11) << c;
    EXPECT_NEAR(student_quantile(c, 2) / (c * std::sqrt(2 / a)), 1, 1e-11) << c;
    EXPECT_NEAR(student_quantile(c, 4) / std::sqrt(q - 4), 1, 1e-11) << c;
  }
}

// Abramowitz & Stegun, "Handbook of Mathematical Functions", 1964, table 26.10: three decimals.
TEST(Confidence, StudentQuantilesAreTheTabulatedOnes) {
  EXPECT_NEAR(student_quantile(0.99, 3), 5.841, 0.0005);
  EXPECT_NEAR(student_quantile(0.99, 5), 4.032, 0.0005);
  EXPECT_NEAR(student_quantile(0.99, 15), 2.947, 0.0005);
  EXPECT_NEAR(student_quantile(0.95, 10), 2.228, 0.0005);
  EXPECT_NEAR(student_quantile(0.99, 1e9), normal_quantile(0.99), 1e-8);
}

TEST(Confidence, StudentQuantilesFallWithEveryFractionOfADegree) {
  double before = student_quantile(0.99, 1);
  for (double degrees = 1.25; degrees < 40; degrees += 0.25) {
    const double now = student_quantile(0.99, degrees);
    EXPECT_LT(now, before) << degrees;
    before = now;
  }
}

TEST(Confidence, WithoutDegreesOfFreedomNothingIsKnown) {
  EXPECT_TRUE(std::isinf(student_quantile(0.99, 0)));
}

}  // namespace
}  // namespace hemibake
