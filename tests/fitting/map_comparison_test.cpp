#include "fitting/map_comparison.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "fitting/models.h"

namespace hemibake {
namespace {

// Makes a map whose light follows g = dark + (open − dark)α exactly, with V = α^bend.
MapCurves exact_map(const std::string& name, double bend, double dark, double open) {
  MapCurves map{name, {}};
  map.curves.bounce_count = 41;
  for (int j = 0; j < 50; ++j) {
    CurveBin bin{j / 50.0, (j + 1) / 50.0, (j + 0.5) / 50, 10, {}};
    const double ao = bin_center(bin), v = std::pow(ao, bend), g = dark + (open - dark) * ao;
    bin.bounces.push_back({kPi * v, 0});
    for (int b = 1; b <= 40; ++b) bin.bounces.push_back({kPi * (1 - v) * g * std::pow(1 - g, b - 1), 0});
    map.curves.bins.push_back(bin);
  }
  return map;
}

const std::vector<std::string> kModels = {"published", "bounded", "visibility", "visibility-ao"};

TEST(MapComparison, TheModelThatHoldsEverywhereWins) {
  const std::vector<MapCurves> maps = {exact_map("a", 0.7, 0.1, 0.9), exact_map("b", 1.0, 0.1, 0.9),
                                       exact_map("c", 1.4, 0.1, 0.9)};
  const MapFits fits = fit_maps(kModels, maps, Abscissa::kCenter, Weights::kNone);
  EXPECT_EQ(fits.comparison.winner, "visibility-ao");
  EXPECT_EQ(fits.comparison.models, kModels);
  ASSERT_EQ(fits.fits.size(), 6U);
  for (const MapErrors& map : fits.comparison.maps) {
    const ModelOnMap& exact = map.models[3];
    // The tail after 40 bounces is geometric, as the light is.
    EXPECT_LT(exact.own->rms, 1e-6);
    EXPECT_LT(exact.shared.rms, 1e-6);
    EXPECT_LT(exact.held_out->rms, 1e-6);
    EXPECT_GT(map.models[1].held_out->rms, 0.01);
  }
}

// Held out, by hand: fitted to the pool of the others and measured on the one.
TEST(MapComparison, HeldOutErrorsAreThoseOfFitsToTheOthers) {
  const std::vector<MapCurves> maps = {exact_map("a", 0.7, 0.1, 0.5), exact_map("b", 1.0, 0.3, 0.9),
                                       exact_map("c", 1.4, 0.1, 0.9)};
  const MapComparison found = fit_maps(kModels, maps, Abscissa::kCenter, Weights::kNone).comparison;
  double sum = 0;
  for (size_t i = 0; i < maps.size(); ++i) {
    std::vector<Curves> others;
    for (size_t j = 0; j < maps.size(); ++j)
      if (j != i) others.push_back(maps[j].curves);
    const auto fits = fit_model("visibility", pool_curves(others), Abscissa::kCenter, Weights::kNone);
    const Score score = score_prediction(fit_model_called("visibility").predict(fits), maps[i].curves);
    EXPECT_EQ(found.maps[i].models[2].held_out->rms, score.rms);
    sum += score.rms;
  }
  EXPECT_DOUBLE_EQ(*found.held_out_rms[2], sum / 3);
}

TEST(MapComparison, ASingleMapHasItsOwnErrorsOnly) {
  const std::vector<MapCurves> maps = {exact_map("a", 1.2, 0.1, 0.5)};
  const MapComparison found = fit_maps(kModels, maps, Abscissa::kCenter, Weights::kNone).comparison;
  EXPECT_EQ(found.winner, "");
  EXPECT_FALSE(found.maps[0].models[0].held_out.has_value());
  EXPECT_EQ(found.maps[0].models[3].own->rms, found.maps[0].models[3].shared.rms);
}

// Flat ground has one bin, which determines nothing alone and takes no part in the winner's mean.
TEST(MapComparison, AMapThatCannotBeFittedIsStillMeasured) {
  MapCurves flat = exact_map("flat", 1, 0.1, 0.9);
  for (size_t j = 0; j + 1 < flat.curves.bins.size(); ++j) flat.curves.bins[j].count = 0;
  const std::vector<MapCurves> maps = {exact_map("a", 0.8, 0.1, 0.9), flat};
  const MapComparison found = fit_maps(kModels, maps, Abscissa::kCenter, Weights::kNone).comparison;
  EXPECT_FALSE(found.maps[1].models[3].own.has_value());
  EXPECT_LT(found.maps[1].models[3].held_out->rms, 1e-6);
  EXPECT_FALSE(found.maps[0].models[3].held_out.has_value()) << "flat ground alone cannot be fitted";
  EXPECT_EQ(found.winner, "");
}

}  // namespace
}  // namespace hemibake
