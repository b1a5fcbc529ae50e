// `hemibake curves` and `hemibake fit` through the real binary.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/constants.h"
#include "io/bake_file.h"
#include "io/curves_file.h"
#include "io/io_testing.h"
#include "model/closed_forms.h"
#include "support/run_command.h"

namespace hemibake {
namespace {

constexpr double kK = 0.79, kE = 1.03, kA = 38.4, kB = 3.85;

class CurvesAndFit : public testing::Test {
 protected:
  // Writes a bake of 400 × 3 texels that follows the published formulas with the constants above.
  void write_model_bake(const std::string& name) const {
    Bake bake;
    bake.width = 400;
    bake.height = 3;
    bake.visible_fraction = Grid<float>(400, 3);
    bake.irradiance.assign(3, Grid<float>(400, 3));
    for (size_t i = 0; i < bake.visible_fraction.size(); ++i) {
      const double ao = (static_cast<double>(i) + 0.5) / 1200;
      const double first = first_bounce_factor(ao, kA, kB);
      bake.visible_fraction[i] = static_cast<float>(ao);
      bake.irradiance[0][i] = static_cast<float>(kPi * direct_factor(ao, kK, kE));
      bake.irradiance[1][i] = static_cast<float>(kPi * first);
      bake.irradiance[2][i] = static_cast<float>(kPi * first * (1 - ao));
    }
    write_bake(folder_ / name, bake, make_provenance("test"));
  }

  CommandOutcome run(const std::string& arguments) const {
    return run_command(fmt::format("cd '{}' && '{}' {}", folder_.path().string(), HEMIBAKE_BINARY, arguments),
                       folder_.path());
  }

  // Expects exit code `code` and one line on standard error.
  void expect_failure(const std::string& arguments, int code, const std::string& line) const {
    const CommandOutcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, code) << arguments;
    EXPECT_EQ(outcome.err, "hemibake: " + line + "\n");
    EXPECT_EQ(outcome.out, "");
  }

  TemporaryFolder folder_;
};

TEST_F(CurvesAndFit, RecoverTheConstantsOfABake) {
  write_model_bake("b.exr");
  const CommandOutcome curves = run("curves b.exr -o c.csv --bins 100 --json");
  ASSERT_EQ(curves.exit_code, 0) << curves.err;
  EXPECT_EQ(nlohmann::json::parse(curves.out).at("populated"), 100);
  EXPECT_EQ(read_curves(folder_ / "c.csv").bins.size(), 100U);

  const CommandOutcome fit = run("fit c.csv -o f.json --json");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  const nlohmann::json json = nlohmann::json::parse(fit.out);
  EXPECT_EQ(json, nlohmann::json::parse(read_bytes(folder_ / "f.json")));
  // Means over bins of width w differ from values at their centres by f″w²/24: w = 0.02 shifts A by 0.35,
  // 0.01 by a quarter.
  EXPECT_NEAR(json.at("F0").at("parameters").at("k").at("value"), kK, 2e-3);
  EXPECT_NEAR(json.at("F0").at("parameters").at("e").at("value"), kE, 2e-3);
  EXPECT_NEAR(json.at("F1").at("parameters").at("A").at("value"), kA, 0.1);
  EXPECT_NEAR(json.at("F1").at("parameters").at("B").at("value"), kB, 0.004);
  EXPECT_EQ(json.at("provenance").at("input"), "c.csv");
  EXPECT_EQ(json.at("provenance").at("command"), "hemibake fit c.csv");
}

TEST_F(CurvesAndFit, SameBytesAtAnyThreadCount) {
  write_model_bake("b.exr");
  for (const std::string threads : {"1", "2"}) {
    ASSERT_EQ(run("curves b.exr -o c" + threads + ".csv --threads " + threads).exit_code, 0);
    ASSERT_EQ(run("fit c1.csv -o f" + threads + ".json --threads " + threads).exit_code, 0);
  }
  EXPECT_EQ(read_bytes(folder_ / "c1.csv"), read_bytes(folder_ / "c2.csv"));
  EXPECT_EQ(read_bytes(folder_ / "f1.json"), read_bytes(folder_ / "f2.json"));
}

TEST_F(CurvesAndFit, EmptyBinsAreSkipped) {
  write_bytes(folder_ / "c.csv",
              "bin,ao_low,ao_high,ao_mean,count,E00_mean,E00_stddev,E01_mean,E01_stddev\n"
              "0,0,0.2,,0,,,,\n1,0.2,0.4,0.3,5,1.3,0.1,0.9,0.1\n2,0.4,0.6,0.5,5,2.0,0.1,0.6,0.1\n"
              "3,0.6,0.8,0.7,5,2.5,0.1,0.3,0.1\n4,0.8,1,0.9,5,3,0.1,0.1,0.1\n");
  const CommandOutcome fit = run("fit c.csv -o f.json --json");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_EQ(nlohmann::json::parse(fit.out).at("F0").at("points"), 4);
}

TEST_F(CurvesAndFit, UnusableCurvesAreRefused) {
  const std::string head = "bin,ao_low,ao_high,ao_mean,count,E00_mean,E00_stddev,E01_mean,E01_stddev\n";
  const auto expect_refusal = [&](const std::string& rows, const std::string& line) {
    write_bytes(folder_ / "c.csv", head + rows);
    expect_failure("fit c.csv -o f.json", 2, line);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "f.json"));
  };
  const std::string few = "usable bins, expected at least 3 for the 2 parameters of published F0";
  expect_refusal("", "c.csv: no bins, expected a line for each");
  expect_refusal("0,0,1,,0,,,,\n", "c.csv: 0 " + few);
  expect_refusal("0,0,1,1,100,3.1416,0,0,0\n", "c.csv: 1 " + few);
  expect_refusal("0,0,1,0.5,-1,1,0,1,0\n", "c.csv:2: count is -1, expected a number from 0");
  expect_refusal("0,0,1,0.5,1.5,1,0,1,0\n", "c.csv:2: count is 1.5, expected a whole number");
  expect_refusal("0,0,1,0.5,1,nan,0,1,0\n",
                 "c.csv:2: column 'E00_mean': \"nan\" is not usable, expected a finite number or nothing");
  expect_refusal("0,0,1,0.5,1,,0,1,0\n", "c.csv:2: E00_mean is empty, expected a number");
}

TEST_F(CurvesAndFit, AFitThatDeterminesNothingExitsOne) {
  std::string rows = "bin,E0,E1\n";
  for (int j = 0; j < 10; ++j) rows += fmt::format("{},{},0\n", j, 0.3 * j + 0.1);
  write_bytes(folder_ / "c.csv", rows);
  expect_failure("fit c.csv -o f.json --model published", 1,
                 "c.csv: fit of published F1: the points do not determine B");
}

TEST_F(CurvesAndFit, PathsFailBeforeTheWork) {
  write_bytes(folder_ / "c.csv", "bin,E0,E1\n");
  expect_failure("fit c.csv -o f.txt", 2, "f.txt: cannot write '.txt' files, expected .json");
  expect_failure("fit c.csv -o none/f.json", 2, "none/f.json: could not write: No such file or directory");
  expect_failure("fit none.csv -o f.json", 2, "none.csv: could not read: No such file or directory");
  expect_failure("curves none.exr -o c.txt", 2, "c.txt: cannot write '.txt' files, expected .csv");
  expect_failure("curves c.csv -o d.csv --bins 0", 2, "--bins: '0', expected a whole number from 1 to 65536");
}

// Returns the widest line, in bytes; UTF-8 makes it no narrower.
size_t widest_line(const std::string& text) {
  size_t widest = 0, begin = 0;
  for (size_t end = text.find('\n'); end != std::string::npos; begin = end + 1, end = text.find('\n', begin))
    widest = std::max(widest, end - begin);
  return widest;
}

const std::string kStored = std::string(HEMIBAKE_SOURCE_DIR) + "/fits/curves";

TEST_F(CurvesAndFit, AFolderOfMapsHasOneSetOfConstantsAndAWinner) {
  std::filesystem::create_directories(folder_ / "maps/bricks");
  std::filesystem::copy(kStored + "/bricks.csv", folder_ / "maps/bricks/curves.csv");
  std::filesystem::copy(kStored + "/noise.csv", folder_ / "maps/noise.csv");
  write_model_bake("maps/model.exr");
  write_bytes(folder_ / "maps/list.csv", "name,size\n");
  const CommandOutcome fit = run("fit maps -o f.json");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  EXPECT_LE(widest_line(fit.out), 100U) << fit.out;
  EXPECT_NE(fit.err.find("maps/list.csv: skipped: no curves"), std::string::npos) << fit.err;

  const nlohmann::json json = nlohmann::json::parse(read_bytes(folder_ / "f.json"));
  EXPECT_EQ(json["provenance"]["input"], "bricks/curves.csv, model.exr, noise.csv");
  ASSERT_EQ(json["maps"].size(), 3U);
  EXPECT_EQ(json["maps"][0]["map"], "bricks");
  EXPECT_NEAR(json["maps"][0]["models"]["bounded"]["parameters"]["bounded_F0"]["k0"].get<double>(), 0.1098,
              0.03);
  const std::string winner = json["held_out"]["winner"];
  for (const auto& [model, rms] : json["held_out"]["rms"].items())
    EXPECT_GE(rms, json["held_out"]["rms"][winner]) << model;
  EXPECT_NE(fit.out.find("carries best from map to map: " + winner), std::string::npos);
  EXPECT_EQ(run("check f.json").exit_code, 0);
}

TEST_F(CurvesAndFit, FoldersWithoutMapsAndMapsOfOneNameAreRefused) {
  std::filesystem::create_directories(folder_ / "maps/a");
  const std::string none =
      "maps: no maps in this folder, expected */curves.csv, */bake.exr, curves as CSV or bakes as EXR; make "
      "them "
      "with 'hemibake run' or 'hemibake bake'";
  expect_failure("fit maps -o f.json", 2, none);
  expect_failure("compare maps", 2, none);
  std::filesystem::copy(kStored + "/bricks.csv", folder_ / "maps/a/curves.csv");
  std::filesystem::copy(kStored + "/bricks.csv", folder_ / "a.csv");
  expect_failure("fit maps a.csv -o f.json", 2,
                 "maps/a/curves.csv, a.csv: two maps of the name 'a', expected a name each; rename one");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "f.json"));
}

TEST_F(CurvesAndFit, CurvesOverVisibilityFitWhatTakesThem) {
  write_model_bake("b.exr");
  ASSERT_EQ(run("curves b.exr -o v.csv --bins 40 --index visibility").exit_code, 0);
  ASSERT_EQ(run("curves b.exr -o a.csv --bins 40").exit_code, 0);
  EXPECT_EQ(read_curves(folder_ / "v.csv").index, CurveIndex::kVisibility);
  EXPECT_NE(run("check v.csv").out.find("ok      E0/pi outside its bin, worst"), std::string::npos);
  const CommandOutcome fit = run("fit v.csv -o f.json --json");
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  const nlohmann::json json = nlohmann::json::parse(fit.out);
  EXPECT_TRUE(json.contains("visibility"));
  EXPECT_FALSE(json.contains("bounded_F0"));
  EXPECT_EQ(json["visibility"]["abscissa"], "visibility");
  for (const std::string model : {"bounded", "published", "visibility-ao", "bounces"})
    expect_failure("fit v.csv -o g.json --model " + model, 2,
                   "v.csv: curves over visibility, expected curves over ao for the model " + model);
  expect_failure("fit v.csv a.csv -o g.json", 2,
                 "v.csv, a.csv: curves over ao and over visibility, expected all of them over the same");
}

TEST_F(CurvesAndFit, ComparisonsAreAtMostAHundredColumnsWide) {
  const CommandOutcome compare = run("compare '" + kStored + "'");
  ASSERT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_LE(widest_line(compare.out), 100U) << compare.out;
  for (const std::string name : {"bricks", "noise", "g = V", "g = a", "visibility-ao"})
    EXPECT_NE(compare.out.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace hemibake
