#include "io/fit_file.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace hemibake {
namespace {

FitFile make_example() {
  Fit fit{"m",
          "a*b",
          {{"A", 2, 0.5}, {"B", 3, std::nullopt}},
          {0.25, 0, 0, 0},
          0.1,
          0.2,
          7,
          1.5,
          Abscissa::kMayaux2018,
          Weights::kStandardError};
  Fit exact = fit;
  exact.aicc.reset();
  return {{{"F0", fit}, {"F1", exact}}, {{"version", "1"}}};
}

TEST(FitFile, JsonIsTheContractOfTheDesign) {
  const nlohmann::ordered_json json = json_from_fits(make_example());
  EXPECT_EQ(
      json.dump(),
      R"({"F0":{"model":"m","formula":"a*b","parameters":{"A":{"value":2.0,"stderr":0.5},)"
      R"("B":{"value":3.0,"stderr":null}},"covariance":[[0.25,0.0],[0.0,0.0]],"rms":0.1,"max_error":0.2,)"
      R"("points":7,"aicc":1.5,"abscissa":"published","weights":"stderr"},)"
      R"("F1":{"model":"m","formula":"a*b","parameters":{"A":{"value":2.0,"stderr":0.5},)"
      R"("B":{"value":3.0,"stderr":null}},"covariance":[[0.25,0.0],[0.0,0.0]],"rms":0.1,"max_error":0.2,)"
      R"("points":7,"aicc":null,"abscissa":"published","weights":"stderr"},)"
      R"("provenance":{"version":"1"}})");
}

TEST(FitFile, ReadsBackWhatWasWritten) {
  const nlohmann::ordered_json json = json_from_fits(make_example());
  EXPECT_EQ(json_from_fits(fits_from_json(json, "f.json")), json);
}

TEST(FitFile, WhatIsMissingIsNamed) {
  nlohmann::ordered_json json = json_from_fits(make_example());
  json["F1"]["parameters"]["A"].erase("value");
  EXPECT_THROW(fits_from_json(json, "f.json"), InputError);
  json["F1"] = 3;
  EXPECT_THROW(fits_from_json(json, "f.json"), InputError);
  EXPECT_THROW(fits_from_json(nlohmann::ordered_json::array(), "f.json"), InputError);
  json = json_from_fits(make_example());
  json["F0"]["weights"] = "some";
  try {
    fits_from_json(json, "f.json");
    FAIL() << "unknown weights passed";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "f.json: F0: 'some', expected one of none, count, stderr");
  }
}

}  // namespace
}  // namespace hemibake
