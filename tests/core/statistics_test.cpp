#include "core/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hemibake {
namespace {

TEST(Statistics, MomentsKeepPrecisionFarFromZero) {
  Moments moments;
  for (const double value : {1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16}) moments.add(value);
  EXPECT_DOUBLE_EQ(moments.mean, 1e9 + 10);
  EXPECT_DOUBLE_EQ(moments.stddev(), std::sqrt(22.5));  // mean of 36, 9, 9, 36
}

TEST(Statistics, NothingHasMeanAndSpreadZero) {
  EXPECT_EQ(Moments{}.stddev(), 0);
  EXPECT_EQ(mean(std::vector<float>{}), 0);
}

TEST(Statistics, RmsDifference) {
  const std::vector<float> a{1, 2, 3}, b{1, 4, 5};
  EXPECT_DOUBLE_EQ(rms_difference(a, b), std::sqrt(8.0 / 3.0));
}

}  // namespace
}  // namespace hemibake
