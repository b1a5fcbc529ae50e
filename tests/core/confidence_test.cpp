#include "core/confidence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hemibake {
namespace {

TEST(Confidence, NormalQuantilesAreTheTabulatedOnes) {
  EXPECT_NEAR(normal_quantile(0.6826894921370859), 1, 1e-12);
  EXPECT_NEAR(normal_quantile(0.95), 1.959963984540054, 1e-12);
  EXPECT_NEAR(normal_quantile(0.99), 2.5758293035489004, 1e-12);
  EXPECT_NEAR(normal_quantile(0.999999), 4.891638475699, 1e-9);
}

TEST(Confidence, StudentQuantilesAreTheTabulatedOnes) {
  EXPECT_NEAR(student_quantile(0.99, 1), 63.6567, 1e-4);
  EXPECT_NEAR(student_quantile(0.99, 2), 9.9248, 1e-4);
  EXPECT_NEAR(student_quantile(0.99, 5), 4.0321, 0.002 * 4.0321);
  EXPECT_NEAR(student_quantile(0.99, 15), 2.9467, 1e-4);
  EXPECT_NEAR(student_quantile(0.95, 10), 2.2281, 1e-4);
  EXPECT_NEAR(student_quantile(0.99, 1e9), 2.5758293, 1e-6);
}

TEST(Confidence, WithoutDegreesOfFreedomNothingIsKnown) {
  EXPECT_TRUE(std::isinf(student_quantile(0.99, 0)));
}

}  // namespace
}  // namespace hemibake
