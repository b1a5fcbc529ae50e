// `hemibake trade` through the real binary: its files, resuming after a stop, refusals.
#include <fmt/format.h>

#include <sstream>

#include "cli/run_hemibake.h"
#include "io/table_io.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

class Trade : public CliTest {
 protected:
  static constexpr const char* kQuick = "trade map.exr -o study --effort quick --threads 1";

  void SetUp() override { write_map("map.exr", SyntheticKind::kBricks, 12, 12); }
  std::string study() const { return run_well(kQuick).standard_output; }
};

TEST_F(Trade, WritesTableJsonAndPictures) {
  EXPECT_THAT(study(), HasSubstr("0 of them on record"));
  const auto json = read_json(folder_ / "study/trade.json");
  EXPECT_EQ(json["effort"], "quick");
  EXPECT_EQ(json["albedos"].size(), 4u);
  EXPECT_GT(json["runs"].size(), 20u);
  for (const char* plane : {"ao", "direct", "light.50"}) {
    EXPECT_GE(json["fronts"][plane].size(), 1u);
    EXPECT_TRUE(json["reference"]["precision"].contains(plane));
  }
  for (const auto& run : json["runs"]) {
    EXPECT_GT(run["cpu_seconds"].get<double>(), 0);
    EXPECT_GE(run["error"].size(), 1u);
  }
  for (const auto& picture : json["pictures"])
    EXPECT_TRUE(std::filesystem::exists(folder_ / "study" / picture["file"].get<std::string>())) << picture;

  // Every line has as many cells as the header.
  std::istringstream csv(read_bytes(folder_ / "study/trade.csv"));
  std::string header, line;
  std::getline(csv, header);
  int lines = 0;
  while (std::getline(csv, line)) {
    ++lines;
    EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(header, ',')) << line;
  }
  EXPECT_GT(lines, static_cast<int>(json["runs"].size()) * 4);
}

TEST_F(Trade, GoesOnWhereItWas) {
  study();
  const auto runs = read_json(folder_ / "study/trade.json")["runs"];
  const std::string first = read_bytes(folder_ / "study/trade.json");
  // CPU seconds are measured, so only records can repeat them.
  EXPECT_THAT(study(), HasSubstr(fmt::format("{0} runs, {0} of them on record", runs.size() + 1)));
  EXPECT_EQ(read_bytes(folder_ / "study/trade.json"), first);

  const std::string id = runs[2]["id"];
  std::filesystem::remove(folder_ / "study/runs" / (id + ".json"));
  write_bytes(folder_ / ("study/runs/" + runs[3]["id"].get<std::string>() + ".json"), "{\"key\": ");
  EXPECT_THAT(study(),
              HasSubstr(fmt::format("{} runs, {} of them on record", runs.size() + 1, runs.size() - 1)));

  EXPECT_THAT(run_well(std::string(kQuick) + " --amplitude 0.05").standard_output,
              HasSubstr("0 of them on record"));
}

TEST_F(Trade, ErrorsAreTheSameAtAnyThreadCount) {
  const auto errors = [&](const std::string& folder, int threads) {
    const auto json =
        run_json(fmt::format("trade map.exr -o {} --effort quick --threads {}", folder, threads));
    nlohmann::json result;
    for (const auto& run : json["runs"]) result[run["id"].get<std::string>()] = {run["error"], run["curve"]};
    return result;
  };
  EXPECT_EQ(errors("one", 1), errors("four", 4));
}

TEST_F(Trade, StopsCleanlyAndGoesOn) {
  write_map("large.exr", SyntheticKind::kBricks, 256, 256);
  const CommandResult stopped = run_interrupted("trade large.exr -o large", "INT");
  EXPECT_EQ(stopped.exit_code, 130);
  EXPECT_EQ(stopped.standard_error, "hemibake: interrupted, no file was left half written\n");
  // The reference alone takes longer than the limit: not even the folder is made.
  EXPECT_FALSE(std::filesystem::exists(folder_ / "large"));
}

TEST_F(Trade, TakesTheSmallestMaps) {
  write_map("one.exr", Grid<float>(1, 1, 0.5f));
  write_map("strip.exr", SyntheticKind::kNoise, 9, 1);
  for (const char* arguments : {"one.exr", "strip.exr --amplitude 0.5", "map.exr --amplitude 0"})
    EXPECT_GT(run_json(fmt::format("trade {} -o small --effort quick", arguments))["runs"].size(), 20u)
        << arguments;
}

TEST_F(Trade, Refuses) {
  expect_refusal("trade absent.exr -o study", HasSubstr("absent.exr"));
  write_bytes(folder_ / "broken.png", "not an image");
  expect_refusal("trade broken.png -o study --effort quick", HasSubstr("broken.png"));
  expect_refusal("trade map.exr -o none/study", HasSubstr("none/study"));
  expect_refusal("trade map.exr -o map.exr", HasSubstr("map.exr"));
  expect_refusal("trade map.exr -o study --effort some", HasSubstr("--effort"));
  expect_refusal("trade map.exr -o study --memory 0", HasSubstr("--memory"));
  expect_refusal("trade map.exr", HasSubstr("--output"));
}

}  // namespace
}  // namespace hemibake
