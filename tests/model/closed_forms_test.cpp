#include "model/closed_forms.h"

#include <gtest/gtest.h>

#include <cmath>

namespace hemibake {
namespace {

TEST(ClosedForms, DirectFactorAtTheCorners) {
  EXPECT_EQ(direct_factor(0.0, 0.5, 0.75), 0);
  EXPECT_EQ(direct_factor(1.0, 0.5, 0.75), 1);
  EXPECT_DOUBLE_EQ(direct_factor(0.5, 0.5, 1.0), 0.625);
  EXPECT_DOUBLE_EQ(direct_factor(0.3, 0.0, 0.75), 0.3);  // k = 0 is plain AO
  EXPECT_DOUBLE_EQ(direct_factor(0.3, 1.0, 1.0), 0.51);  // k = e = 1 is the upper bound α(2 − α)
}

TEST(ClosedForms, PublishedDirectFactorExceedsOneFrom0949253) {
  EXPECT_LT(direct_factor(0.949252, 0.5, 0.75), 1);
  EXPECT_GT(direct_factor(0.949254, 0.5, 0.75), 1);
}

TEST(ClosedForms, FirstBounceFactorVanishesAtBothEnds) {
  EXPECT_EQ(first_bounce_factor(0.0, 27.0, 3.0), 0);
  EXPECT_EQ(first_bounce_factor(1.0, 27.0, 3.0), 0);
  EXPECT_EQ(first_bounce_factor(100.0 / 99, 27.0, 3.0), 0);  // the published abscissa leaves 0..1
  EXPECT_DOUBLE_EQ(first_bounce_factor(0.0625, 2.0, 3.0),
                   2 * 0.0625 * std::pow(0.9375, 1.5) * std::exp(-1.5));
}

TEST(ClosedForms, FirstBounceIsTheGeneralFormWithAQuarter) {
  for (double ao = 0.01; ao < 1; ao += 0.07) {
    EXPECT_NEAR(first_bounce_factor(ao, 27.6, 3.34), bounce_factor(ao, 27.6, 3.34, 0.25), 1e-14);
  }
}

// g is α where α = m, nearer to m elsewhere, in 0..1, and rises with both.
TEST(ClosedForms, MeanEscapeShareDrawsAoTowardsTheMean) {
  for (double m = 0; m <= 1; m += 0.125) {
    EXPECT_EQ(mean_escape_share(0.0, m), 0);
    EXPECT_EQ(mean_escape_share(1.0, m), (1 + m) / 2);
    EXPECT_DOUBLE_EQ(mean_escape_share(m, m), m);
    for (double ao = 0.125; ao <= 1; ao += 0.125) {
      const double g = mean_escape_share(ao, m);
      EXPECT_GE(g, std::min(ao, m));
      EXPECT_LE(g, std::max(ao, m));
      EXPECT_GT(g, mean_escape_share(ao - 0.125, m));
      EXPECT_LT(g, mean_escape_share(ao, m + 0.125));
    }
  }
}

TEST(ClosedForms, NormalEscapeShareRisesWithVisibilityUpToOne) {
  EXPECT_DOUBLE_EQ(normal_escape_share(0.5, 0.5), 0.5);  // g = V halfway up
  EXPECT_DOUBLE_EQ(normal_escape_share(1.0, 1.0), 0.7);
  EXPECT_EQ(normal_escape_share(1.0, 0.0), 1);
  for (double z = 0; z <= 1; z += 0.125) {
    EXPECT_EQ(normal_escape_share(0.0, z), 0);
    for (double v = 0.125; v <= 1; v += 0.125) {
      EXPECT_GE(normal_escape_share(v, z), normal_escape_share(v - 0.125, z));
      EXPECT_LE(normal_escape_share(v, z), 1);
    }
  }
}

}  // namespace
}  // namespace hemibake
