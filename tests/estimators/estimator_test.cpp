#include "estimators/estimator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <set>
#include <string>

#include "core/parallel.h"
#include "support/maps.h"
#include "support/threads.h"

namespace hemibake {
namespace {

// Every estimator with its defaults, and alchemy in perspective too.
template <class Each>
void for_each_variant(const Each& each) {
  for (const Estimator& estimator : estimators())
    each(estimator, EstimatorOptions{}, std::string(estimator.name));
  EstimatorOptions perspective;
  perspective.alchemy.projection = Projection::kPerspective;
  each(*find_estimator("alchemy"), perspective, "alchemy, perspective");
  EstimatorOptions uniform;
  uniform.horizon.kind = AoKind::kUniform;
  each(*find_estimator("horizon"), uniform, "horizon, uniform");
}

TEST(Estimators, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Estimator& estimator : estimators()) {
    EXPECT_TRUE(names.insert(estimator.name).second);
    EXPECT_EQ(find_estimator(estimator.name), &estimator);
  }
  EXPECT_EQ(names, (std::set<std::string>{"alchemy", "disk", "disk-robust", "horizon"}));
  EXPECT_EQ(find_estimator("ray"), nullptr);
}

void expect_sane(const Estimate& estimate, const Surface& surface, const std::string& name) {
  ASSERT_EQ(estimate.ao.width, surface.width());
  ASSERT_EQ(estimate.ao.height, surface.height());
  for (const float ao : estimate.ao.values) {
    ASSERT_GE(ao, 0) << name;
    ASSERT_LE(ao, 1) << name;
  }
  for (const glm::vec3& bent : estimate.bent_normals.values) ASSERT_NEAR(glm::length(bent), 1, 1e-5) << name;
}

TEST(Estimators, ExtremesStayFinite) {
  for (const double amplitude : {0.0, 1e-6, 0.1, 1e3}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 17}, {17, 1}, {2, 2}, {19, 12}}) {
      for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
        if (edge == Edge::kOpen && (width < 2 || height < 2)) continue;  // spans no surface
        const Surface surface = white_noise_surface(width, height, amplitude, edge);
        for_each_variant(
            [&](const Estimator& estimator, const EstimatorOptions& options, const std::string& name) {
              const Estimate estimate = estimator.estimate(surface, options);
              expect_sane(estimate, surface, name);
              if (amplitude > 0) return;
              for (const float ao : estimate.ao.values) ASSERT_NEAR(ao, 1, 1e-6) << name;
            });
      }
    }
  }
}

// A millionth of relief hides next to nothing.
TEST(Estimators, LowReliefIsNearlyOpen) {
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, 32, 32, 1e-6);
  for_each_variant([&](const Estimator& estimator, const EstimatorOptions& options, const std::string& name) {
    for (const float ao : estimator.estimate(surface, options).ao.values) ASSERT_GT(ao, 0.999) << name;
  });
}

template <class T>
bool same_bytes(const Grid<T>& a, const Grid<T>& b) {
  return a.size() == b.size() &&
         (a.empty() || std::memcmp(a.values.data(), b.values.data(), a.size() * sizeof(T)) == 0);
}

TEST(Estimators, GiveTheSameBytesAtAnyThreadCount) {
  const Surface surface = white_noise_surface(48, 40, 0.2);
  for_each_variant([&](const Estimator& estimator, const EstimatorOptions& options, const std::string& name) {
    set_thread_count(1);
    const Estimate one = estimator.estimate(surface, options);
    set_thread_count(4);
    const Estimate four = estimator.estimate(surface, options);
    set_thread_count(0);
    EXPECT_TRUE(same_bytes(one.ao, four.ao)) << name;
    EXPECT_TRUE(same_bytes(one.bent_normals, four.bent_normals)) << name;
    EXPECT_EQ(one.work, four.work) << name;
  });
}

}  // namespace
}  // namespace hemibake
