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

}  // namespace
}  // namespace hemibake
