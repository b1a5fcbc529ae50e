// The constants of 2018 out of the curves of 2018 (../shared/reference, skipped where absent).
#include <gtest/gtest.h>

#include <filesystem>

#include "fitting/models.h"
#include "io/curves_file.h"

namespace hemibake {
namespace {

class PublishedCurves : public testing::Test {
 protected:
  void SetUp() override {
    const std::filesystem::path path = std::filesystem::path(HEMIBAKE_REFERENCE_DIR) / "published_curves.csv";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there";
    curves_ = read_curves(path);
  }

  Curves curves_;
};

TEST_F(PublishedCurves, AreRead) {
  EXPECT_EQ(curves_.bins.size(), 100U);
  EXPECT_EQ(curves_.bounce_count, 21);
  EXPECT_FALSE(curves_.has_counts);
}

// The published digits, to the bar of 10⁻⁵: the fit of 2018 stopped about 5·10⁻⁶ short of the minimum.
TEST_F(PublishedCurves, GiveThePublishedConstantsAtThePublishedAbscissa) {
  const std::vector<NamedFit> fits = fit_model("published", curves_, Abscissa::kMayaux2018, Weights::kNone);
  EXPECT_NEAR(parameter_value(fits[1].fit, "A") / 27.576937094210385, 1, 1e-5);
  EXPECT_NEAR(parameter_value(fits[1].fit, "B") / 3.3364392003423804, 1, 1e-5);
  EXPECT_NEAR(parameter_value(fits[1].fit, "A"), 27.5768064, 5e-7);  // an independent fit of the same data
  EXPECT_NEAR(parameter_value(fits[1].fit, "B"), 3.3364329, 5e-7);
}

TEST_F(PublishedCurves, GiveOtherConstantsAtBinCenters) {
  const std::vector<NamedFit> fits = fit_model("published", curves_, Abscissa::kCenter, Weights::kNone);
  EXPECT_NEAR(parameter_value(fits[0].fit, "k"), 0.51608, 1e-5);
  EXPECT_NEAR(parameter_value(fits[0].fit, "e"), 0.75360, 1e-5);
  EXPECT_NEAR(fits[0].fit.rms, 0.00634, 1e-5);
  EXPECT_NEAR(parameter_value(fits[1].fit, "A"), 32.4492, 1e-4);
  EXPECT_NEAR(parameter_value(fits[1].fit, "B"), 3.56881, 1e-5);
  EXPECT_NEAR(fits[1].fit.rms, 0.00607, 1e-5);
}

TEST_F(PublishedCurves, HaveNoCountsToWeighBy) {
  EXPECT_THROW(fit_model("published", curves_, Abscissa::kCenter, Weights::kCount), std::runtime_error);
}

}  // namespace
}  // namespace hemibake
