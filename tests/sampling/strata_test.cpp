#include "sampling/strata.h"

#include <gtest/gtest.h>

namespace hemibake {
namespace {

TEST(Strata, OneInEach) {
  constexpr uint32_t kCount = 1003, kWanted = 17;
  const std::vector<uint32_t> places = stratified_sample(kCount, kWanted, 5);
  ASSERT_EQ(places.size(), kWanted);
  for (uint32_t i = 0; i < kWanted; ++i) {
    EXPECT_GE(places[i] + 1, i * kCount / kWanted);
    EXPECT_LE(places[i], (i + 1) * kCount / kWanted);
  }
  EXPECT_NE(places, stratified_sample(kCount, kWanted, 6));
}

TEST(Strata, AllWhereThereAreNoMore) {
  EXPECT_EQ(stratified_sample(3, 17, 5), (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(stratified_sample(0, 17, 5).empty());
}

}  // namespace
}  // namespace hemibake
