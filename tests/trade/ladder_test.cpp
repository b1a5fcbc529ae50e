#include "trade/ladder.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/constants.h"
#include "support/maps.h"

namespace hemibake {
namespace {

TEST(Ladder, RunsHaveNamesOfTheirOwnThatAreFileNames) {
  for (const Effort effort : {Effort::kQuick, Effort::kNormal, Effort::kFull}) {
    std::set<std::string> ids;
    std::map<std::string, int> representatives;
    for (const TradeRun& run : make_ladder(effort, true)) {
      EXPECT_TRUE(ids.insert(run.id()).second) << run.id();
      EXPECT_EQ(
          run.id().find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-."),
          std::string::npos)
          << run.id();
      representatives[run.method] += run.representative ? 1 : 0;
    }
    for (const char* method : {"embree", "embree-light", "slice", "slice-light", "march", "cut", "disk",
                               "disk-robust", "disk-light", "alchemy", "horizon", "horizon-uniform"})
      EXPECT_EQ(representatives[method], 1) << method << " at effort " << static_cast<int>(effort);
  }
  EXPECT_LT(make_ladder(Effort::kQuick, true).size(), make_ladder(Effort::kNormal, true).size());
  EXPECT_LT(make_ladder(Effort::kNormal, true).size(), make_ladder(Effort::kFull, true).size());
}

TEST(Ladder, HasTheEndsOfTheIssue) {
  std::set<double> rays;
  std::set<std::string> bounces;
  for (const TradeRun& run : make_ladder(Effort::kNormal, true)) {
    if (run.method == "embree") rays.insert(run.abscissa);
    if (run.method == "slice-light") bounces.insert(run.settings["bounces"].dump());
  }
  EXPECT_EQ(*rays.begin(), 4);
  EXPECT_EQ(*rays.rbegin(), 4096);
  EXPECT_TRUE(bounces.contains("1"));
  EXPECT_TRUE(bounces.contains("40"));
}

TEST(Ladder, OddMapsAreNotHalved) {
  for (const TradeRun& run : make_ladder(Effort::kNormal, false))
    EXPECT_FALSE(run.method.starts_with("half")) << run.id();
}

// Every run of the quick ladder on a small map: planes of the right size, in 0..1 but for the light between
// disks, which is not bound.
TEST(Ladder, EveryRunGivesItsPlanes) {
  const Surface surface = synthetic_surface(SyntheticKind::kBricks, 12, 10, 0.1);
  const Grid<float> direct(12, 10, static_cast<float>(kPi / 2));
  for (const TradeRun& run : make_ladder(Effort::kQuick, true)) {
    const RunPlanes planes = run.perform(surface, direct);
    int there = 0;
    for (const NamedPlane& named : named_planes()) {
      const Grid<float>& plane = named.of(planes);
      if (plane.empty()) continue;
      ++there;
      ASSERT_EQ(plane.width, 12) << run.id();
      ASSERT_EQ(plane.height, 10) << run.id();
      for (const float value : plane.values) {
        ASSERT_GE(value, -1e-6) << run.id() << " " << named.name;
        if (run.method != "disk-light") {
          ASSERT_LE(value, 1 + 1e-5) << run.id() << " " << named.name;
        }
      }
    }
    EXPECT_GE(there, 1) << run.id();
  }
}

TEST(Ladder, BouncesAreSummedAtEveryAlbedo) {
  std::vector<Grid<float>> irradiance;
  for (const double value : {1.0, 0.5, 0.25}) irradiance.emplace_back(2, 1, static_cast<float>(kPi * value));
  RunPlanes planes;
  add_bounces(irradiance, planes);
  EXPECT_NEAR(planes.first_bounce[1], 0.5, 1e-6);
  for (size_t a = 0; a < kJudgedAlbedos.size(); ++a) {
    const double rho = kJudgedAlbedos[a];
    EXPECT_NEAR(planes.all_bounces[a][0], 1 + rho * 0.5 + rho * rho * 0.25, 1e-6);
  }
}

}  // namespace
}  // namespace hemibake
