#include "tracers/hit_form_factors.h"

#include <gtest/gtest.h>

#include "support/maps.h"
#include "support/rows.h"

namespace hemibake {
namespace {

TEST(HitFormFactors, EqualPatchesBecomeOne) {
  Row row;
  row.direct_over_pi = 0.25;
  row.links = {{5, 0.25f}, {2, 0.125f}, {5, 0.25f}, {2, 0.125f}};
  complete_row(row);
  ASSERT_EQ(row.links.size(), 2u);
  EXPECT_EQ(row.links[0].patch, 2u);
  EXPECT_EQ(row.links[0].weight, 0.25f);
  EXPECT_EQ(row.links[1].patch, 5u);
  EXPECT_EQ(row.links[1].weight, 0.5f);
}

TEST(HitFormFactors, RowSumsToOneWhateverTheWeightsRoundTo) {
  Row row;
  for (uint32_t i = 0; i < 1000; ++i) row.links.push_back({i % 37, 0.7f / 1000});
  row.direct_over_pi = 0.3;
  complete_row(row);
  // Half a unit in the last place of the largest weight, about 0.02.
  EXPECT_NEAR(row_sum(row), 1, 1e-9);
}

TEST(HitFormFactors, OpenGroundIsExactlyOne) {
  Row row;
  row.direct_over_pi = 0.9999999999;
  complete_row(row);
  EXPECT_EQ(row.direct_over_pi, 1);
}

TEST(HitFormFactors, BilinearFormFactorsAverageToTheHit) {
  const Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 4);
  std::vector<FormFactor> links;
  add_bilinear_form_factors(surface, {2.25, 1.5}, 1, links);
  ASSERT_EQ(links.size(), 4u);
  double x = 0, y = 0;
  for (const FormFactor& link : links) {
    x += static_cast<double>(link.weight) * (link.patch % 8);
    y += static_cast<double>(link.weight) * (link.patch / 8);
  }
  EXPECT_NEAR(x, 2.25, 1e-6);
  EXPECT_NEAR(y, 1.5, 1e-6);
}

TEST(HitFormFactors, PositionsWrapOrClampAtTheBorder) {
  const Surface wrapped = synthetic_surface(SyntheticKind::kFlat, 8, 4);
  std::vector<FormFactor> links;
  add_nearest_form_factor(wrapped, {7.6, -0.6}, 1, links);
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].patch, 3u * 8 + 0);

  const Surface open = synthetic_surface(SyntheticKind::kFlat, 8, 4, {}, {}, Edge::kOpen);
  links.clear();
  add_bilinear_form_factors(open, {7, 3}, 1, links);
  ASSERT_EQ(links.size(), 1u);
  EXPECT_EQ(links[0].patch, 3u * 8 + 7);
}

}  // namespace
}  // namespace hemibake
