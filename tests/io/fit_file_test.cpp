#include "io/fit_file.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "io/io_testing.h"

namespace hemibake {
namespace {

FitFile make_example() {
  Fit fit{"m",
          "a*b",
          {{"A", 2, 0.5, false}, {"B", 3, std::nullopt, true}},
          {0.25, 0, 0, 0},
          0.1,
          0.2,
          7,
          1.5,
          Abscissa::kMayaux2018,
          Weights::kStandardError};
  Fit exact = fit;
  exact.aicc.reset();
  return {{{"F0", fit}, {"F1", exact}}, {{"version", "1"}}, {}};
}

TEST(FitFile, JsonIsTheContractOfTheDesign) {
  const nlohmann::ordered_json json = json_from_fits(make_example());
  EXPECT_EQ(
      json.dump(),
      R"({"F0":{"model":"m","formula":"a*b","parameters":{"A":{"value":2.0,"stderr":0.5},)"
      R"("B":{"value":3.0,"stderr":null,"on_bound":true}},"covariance":[[0.25,0.0],[0.0,0.0]],"rms":0.1,"max_error":0.2,)"
      R"("points":7,"aicc":1.5,"abscissa":"published","weights":"stderr"},)"
      R"("F1":{"model":"m","formula":"a*b","parameters":{"A":{"value":2.0,"stderr":0.5},)"
      R"("B":{"value":3.0,"stderr":null,"on_bound":true}},"covariance":[[0.25,0.0],[0.0,0.0]],"rms":0.1,"max_error":0.2,)"
      R"("points":7,"aicc":null,"abscissa":"published","weights":"stderr"},)"
      R"("provenance":{"version":"1"}})");
}

TEST(FitFile, ReadsBackWhatWasWritten) {
  const nlohmann::ordered_json json = json_from_fits(make_example());
  EXPECT_EQ(json_from_fits(fits_from_json(json, "f.json")), json);
}

TEST(FitFile, MapsAndTheWinnerAreWrittenAndNotReadBack) {
  FitFile file = make_example();
  const nlohmann::ordered_json without = json_from_fits(file);
  file.comparison.models = {"bounded"};
  ModelOnMap model{file.fits, Score{0.1, 0.2}, {0.3, 0.4}, Score{0.5, 0.6}};
  file.comparison.maps = {{"bricks", 0.25, {model}}, {"flat", std::nullopt, {ModelOnMap{}}}};
  file.comparison.held_out_rms = {0.5};
  file.comparison.winner = "bounded";
  const nlohmann::ordered_json json = json_from_fits(file);
  const nlohmann::ordered_json& bricks = json["maps"][0];
  EXPECT_EQ(bricks["map"], "bricks");
  EXPECT_EQ(bricks["mean_escape"], 0.25);
  EXPECT_EQ(
      bricks["models"]["bounded"].dump(),
      R"({"parameters":{"F0":{"A":2.0,"B":3.0},"F1":{"A":2.0,"B":3.0}},"own":{"rms":0.1,"max_error":0.2},)"
      R"("shared":{"rms":0.3,"max_error":0.4},"held_out":{"rms":0.5,"max_error":0.6}})");
  EXPECT_TRUE(json["maps"][1]["mean_escape"].is_null());
  EXPECT_TRUE(json["maps"][1]["models"]["bounded"]["parameters"].is_null());
  EXPECT_EQ(json["held_out"].dump(), R"({"winner":"bounded","rms":{"bounded":0.5}})");
  EXPECT_EQ(json_from_fits(fits_from_json(json, "f.json")), without);
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
    EXPECT_STREQ(error.what(), "f.json: F0/weights: 'some', expected one of none, count, stderr");
  }
}

TEST(FitFile, WrongTypesAndSizesAreNamed) {
  const auto refusal = [](const char* pointer, const nlohmann::ordered_json& value) {
    nlohmann::ordered_json json = json_from_fits(make_example());
    json[nlohmann::ordered_json::json_pointer(pointer)] = value;
    return error_of<InputError>([&] { fits_from_json(json, "f.json"); });
  };
  using nlohmann::ordered_json;
  EXPECT_EQ(refusal("/F0/points", 1e308),
            "f.json: F0/points is 1e+308, expected a whole number from 0 to 2147483647");
  for (const ordered_json& points :
       {ordered_json(-1), ordered_json(0.5), ordered_json(UINT64_MAX), ordered_json("7")})
    EXPECT_THAT(refusal("/F0/points", points), testing::HasSubstr("f.json: F0/points is "));
  EXPECT_EQ(refusal("/F1/model", 5), "f.json: F1/model is 5, expected a text");
  EXPECT_EQ(refusal("/F1/rms", -1), "f.json: F1/rms is -1, expected a number from 0");
  EXPECT_EQ(refusal("/F1/rms", nullptr), "f.json: F1/rms is null, expected a number from 0");
  EXPECT_EQ(refusal("/F0/parameters/A/on_bound", 1),
            "f.json: F0/parameters/A/on_bound is 1, expected true or false");
  EXPECT_EQ(refusal("/F0/covariance", {{1.25}}),
            "f.json: F0/covariance is a list of 1, expected a row for each of 2 parameters");
  EXPECT_EQ(refusal("/F0/covariance", {{1, 2}, {3}}),
            "f.json: F0/covariance/1 is a list of 1, expected a number for each of 2 parameters");
  EXPECT_EQ(refusal("/F0/covariance", {{1, 2}, {3, "x"}}),
            "f.json: F0/covariance/1/1 is \"x\", expected a number");
  EXPECT_EQ(refusal("/provenance", ordered_json::array()),
            "f.json: provenance is a list of 0, expected an object");
  EXPECT_EQ(refusal("/provenance/input", 5), "f.json: provenance/input is 5, expected a text");
  EXPECT_EQ(refusal("/maps", {{{"map", "m"}, {"mean_escape", 2}}}),
            "f.json: maps/0/mean_escape is 2, expected a number from 0 to 1");
}

}  // namespace
}  // namespace hemibake
