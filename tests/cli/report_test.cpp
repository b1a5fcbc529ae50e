// `hemibake report` through the real binary; what the page does is tested in a browser
// (tests/report/browser).
#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "cli/run_hemibake.h"
#include "core/constants.h"
#include "io/bake_file.h"
#include "report/html_page.h"

namespace hemibake {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class Report : public CliTest {
 protected:
  void SetUp() override {
    if (page_template().empty()) GTEST_SKIP() << "this build has no report";
  }

  // Writes a small bake and all that `run` makes of it.
  void bake(const std::string& folder, const std::string& options = "") {
    if (!std::filesystem::exists(folder_ / "map.exr")) write_map("map.exr", SyntheticKind::kBricks, 24, 20);
    const CommandResult result = run(fmt::format("run map.exr -o {} --rays 64 {}", folder, options));
    ASSERT_LE(result.exit_code, 1) << result.standard_error;
  }

  std::string page(const std::string& folder) const { return read_bytes(folder_ / folder / "report.html"); }
};

TEST_F(Report, SaysWhatThePageShouldShow) {
  bake("out");
  const json said = run_json("report out --albedo 0.9,0.5,0");
  EXPECT_EQ(said.at("output"), "out/report.html");
  EXPECT_EQ(said.at("bytes"), std::filesystem::file_size(folder_ / "out/report.html"));
  EXPECT_EQ(said.at("image"), json({24, 20}));
  const Bake bake = read_bake(folder_ / "out/bake.exr").bake;
  ASSERT_EQ(said.at("probes").size(), 16U);
  for (const json& probe : said.at("probes")) {
    const size_t texel = bake.visible_fraction.index(probe.at("x"), probe.at("y"));
    EXPECT_EQ(probe.at("ao"), bake.visible_fraction[texel]);
    double truth = 0;
    for (size_t b = 0; b < bake.irradiance.size(); ++b)
      truth += std::pow(0.5, b) * bake.irradiance[b][texel] / kPi;
    EXPECT_NEAR(probe.at("truth").at(1).get<double>(), truth, 1e-12);
    EXPECT_NEAR(probe.at("truth").at(2).get<double>(), bake.irradiance[0][texel] / kPi, 1e-12);
    for (const char* model : {"bounded", "published", "notes"})
      EXPECT_EQ(probe.at("models").at(model).size(), 3U);
    const double visibility = probe.at("visibility"), bounce = probe.at("bounce");
    EXPECT_EQ(visibility, bake.visibility[texel]);
    EXPECT_EQ(bounce, bake.bounce[texel]);
    // At the albedo of the map, .9, its light is the map's; at 0 all is V.
    EXPECT_NEAR(probe.at("models").at("bounce-map").at(0).get<double>(), bounce, 1e-12);
    for (const char* model : {"bounce-map", "visibility", "visibility-ao"})
      EXPECT_NEAR(probe.at("models").at(model).at(2).get<double>(), visibility, 1e-12);
    const auto escaping = [&](double g) { return 1 - (1 - visibility) * 0.5 / (0.5 + 0.5 * g); };
    EXPECT_NEAR(probe.at("models").at("visibility").at(1).get<double>(), escaping(visibility), 1e-12);
    EXPECT_NEAR(probe.at("models").at("visibility-ao").at(1).get<double>(), escaping(probe.at("ao")), 1e-12);
  }
  EXPECT_LE(said.at("total_error_over_pi"), 21 * 0.5 / 65535 * 1.001);
}

TEST_F(Report, IsTheSameAtAnyThreadCount) {
  bake("out");
  run_well("report out -o one.html --threads 1");
  run_well("report out -o four.html --threads 4");
  EXPECT_EQ(read_bytes(folder_ / "one.html"), read_bytes(folder_ / "four.html"));
}

// Expects a page that names the missing parts. The browser test opens such pages.
TEST_F(Report, TakesWhatIsThere) {
  bake("bounces", "--bounces 0");
  run_well("report bounces");
  EXPECT_THAT(page("bounces"), Not(HasSubstr("data-name=\"irradiance.01\"")));

  bake("bin", "--bins 1");
  run_well("report bin");

  bake("all");
  for (const char* name : {"bake.exr", "curves.csv", "fit.json", "check.json"}) {
    std::filesystem::create_directory(folder_ / "alone");
    std::filesystem::copy(folder_ / "all" / name, folder_ / "alone" / name);
    run_well("report alone");
    std::filesystem::remove_all(folder_ / "alone");
  }

  std::filesystem::create_directory(folder_ / "ao");
  run_well("bake map.exr -o ao/bake.exr --outputs ao --rays 16");
  run_well("report ao");
  EXPECT_THAT(page("ao"), Not(HasSubstr("data-name=\"irradiance")));

  std::filesystem::create_directory(folder_ / "light");
  run_well("bake map.exr -o light/bake.exr --outputs irradiance --rays 16");
  run_well("report light");
}

// Folders of older versions: V is E₀/π, and there is no bounce map.
TEST_F(Report, BakesOfOlderVersions) {
  bake("out");
  BakeFile file = read_bake(folder_ / "out/bake.exr");
  const std::vector<float> visibility = file.bake.visibility.values;
  file.bake.visibility = file.bake.bounce = {};
  write_bake(folder_ / "out/bake.exr", file.bake, file.provenance);
  std::filesystem::remove(folder_ / "out/check.json");  // of the bake that is replaced
  const json said = run_json("report out");
  EXPECT_THAT(page("out"), Not(HasSubstr("\"id\":\"bounce-map\"")));
  EXPECT_THAT(page("out"), HasSubstr("\"mean_visibility\":0."));
  for (const json& probe : said.at("probes")) {
    const size_t texel = file.bake.visible_fraction.index(probe.at("x"), probe.at("y"));
    EXPECT_NEAR(probe.at("visibility").get<double>(), visibility[texel], 1e-7);
    EXPECT_FALSE(probe.contains("bounce"));
    EXPECT_FALSE(probe.at("models").contains("bounce-map"));
    EXPECT_TRUE(probe.at("models").contains("visibility-ao"));
  }
}

TEST_F(Report, FindsTheSweep) {
  bake("out");
  std::filesystem::create_directory(folder_ / "out/sweep");
  for (const char* name : {"0.01.csv", "1.csv", "notes.csv", "-3.csv"})
    std::filesystem::copy(folder_ / "out/curves.csv", folder_ / "out/sweep" / name);
  run_well("report out");
  EXPECT_THAT(page("out"), HasSubstr("\"amplitude_m\":0.01"));
  EXPECT_THAT(page("out"), HasSubstr("\"amplitude_m\":1.0"));
  EXPECT_THAT(page("out"), Not(HasSubstr("\"amplitude_m\":-3")));
}

TEST_F(Report, ShowsPicturesOfTheFolderOnly) {
  bake("out");
  std::filesystem::create_directory(folder_ / "out/pictures");
  std::ofstream(folder_ / "out/pictures/wall.png") << "PNG";
  std::ofstream(folder_ / "out/secret.png") << "SECRET";
  std::ofstream(folder_ / "out/pictures/large.png") << std::string(3000001, 'x');
  std::ofstream(folder_ / "out/pictures/render.json")
      << R"({"pictures": [{"name": "wall", "files": ["wall.exr", "wall.png"]}, {"files": ["../secret.png"]},
             {"files": ["large.png"]}, {"files": ["gone.png"]}]})";
  run_well("report out");
  EXPECT_THAT(
      page("out"),
      HasSubstr("\"pictures\":[{\"name\":\"large\",\"here\":false},{\"name\":\"wall\",\"here\":true}]"));
  EXPECT_THAT(page("out"), HasSubstr("data-index=\"1\">UE5H</script>"));
}

// A link within the folder is followed; one that leads out is left out and named.
TEST_F(Report, LeavesOutWhatLinksLeadTo) {
  bake("out");
  write_bytes(folder_ / "secret.png", "SECRET");
  write_bytes(folder_ / "secret.json", R"({"password": "SECRET"})");
  write_bytes(folder_ / "out/wall.png", "PNG");
  std::filesystem::create_symlink("wall.png", folder_ / "out/inside.png");
  std::filesystem::create_symlink("../secret.png", folder_ / "out/outside.png");
  std::filesystem::create_symlink(folder_ / "secret.json", folder_ / "out/run.json");
  std::filesystem::create_directory(folder_ / "elsewhere");
  write_bytes(folder_ / "elsewhere/render.json", R"({"pictures": [{"files": ["other.png"]}]})");
  write_bytes(folder_ / "elsewhere/other.png", "SECRET");
  std::filesystem::create_directory_symlink("../elsewhere", folder_ / "out/pictures");
  write_bytes(folder_ / "out/render.json",
              R"({"pictures": [{"files": ["inside.png"]}, {"files": ["outside.png"]}]})");
  const CommandResult result = run_well("report out");
  for (const char* name : {"out/outside.png", "out/run.json", "out/pictures/render.json"})
    EXPECT_THAT(result.standard_error,
                HasSubstr(std::string(name) + ": is left out: it is a link that leads out of the folder\n"));
  EXPECT_THAT(page("out"), HasSubstr("\"pictures\":[{\"name\":\"inside\",\"here\":true}]"));
  EXPECT_THAT(page("out"), Not(HasSubstr("SECRET")));
  EXPECT_THAT(page("out"), Not(HasSubstr("U0VDUkVU")));  // SECRET in base 64
}

TEST_F(Report, RefusesRecordsOfOtherTypes) {
  bake("out");
  std::filesystem::rename(folder_ / "out/check.json", folder_ / "right.json");
  const json right = json::parse(read_bytes(folder_ / "right.json"));
  const json run = json::parse(R"({"method": "slice", "settings": {"rays": 4}, "representative": true,
      "cpu_seconds": 1, "memory_bytes": 2, "error": {"ao": {"rmse": 1, "bias": 1}}, "models": {}})");
  const json trade = {
      {"effort", "quick"},
      {"runs", {run}},
      {"series", {{{"name", "s"}, {"plane", "ao"}, {"slope", nullptr}, {"points", {{1, 2}}}}}},
      {"fronts", {{"ao", {{{"cpu_seconds", 1}, {"rmse", 2}}}}}}};
  const auto expect_each = [&](const std::string& name, json whole, const std::vector<std::string>& places) {
    write_bytes(folder_ / "out" / name, whole.dump());
    run_well("report out");
    std::filesystem::remove(folder_ / "out/report.html");
    for (const std::string& place : places)
      for (const json& wrong : {json("text"), json(json::array({json::object()}))}) {
        json& value = whole.at(json::json_pointer("/" + place));
        if (wrong.type() == value.type() || (place.ends_with("rays") && wrong.is_string())) continue;
        const json before = std::exchange(value, wrong);
        write_bytes(folder_ / "out" / name, whole.dump());
        value = before;
        expect_refusal("report out", AllOf(HasSubstr("out/" + name + ": "), HasSubstr(", expected ")));
      }
    std::filesystem::remove(folder_ / "out" / name);
  };
  expect_each("check.json", right, {"checks/0", "checks/0/quantity", "checks/0/value", "checks/0/passed"});
  expect_each("run.json", {{"seconds", 1.5}, {"cpu_seconds", 2}}, {"seconds", "cpu_seconds"});
  expect_each("trade.json", trade,
              {"effort", "runs/0", "runs/0/method", "runs/0/settings", "runs/0/settings/rays",
               "runs/0/cpu_seconds", "runs/0/memory_bytes", "runs/0/error", "runs/0/error/ao",
               "runs/0/error/ao/rmse", "runs/0/models", "series", "series/0/slope", "series/0/points",
               "series/0/points/0", "series/0/points/0/1", "fronts", "fronts/ao", "fronts/ao/0/rmse"});
  expect_each("render.json", {{"pictures", {{{"files", {"a.png"}}}}}},
              {"pictures", "pictures/0", "pictures/0/files", "pictures/0/files/0"});
}

TEST_F(Report, SmallerImage) {
  bake("out");
  const json said = run_json("report out --image-size 10");
  EXPECT_EQ(said.at("stride"), 3);
  EXPECT_EQ(said.at("image"), json({8, 7}));
}

TEST_F(Report, RefusesWhatItCannotUse) {
  expect_refusal("report nowhere", "nowhere: is not a folder, expected one that 'hemibake run' wrote");
  std::filesystem::create_directory(folder_ / "empty");
  expect_refusal("report empty", HasSubstr("empty: has none of bake.exr, curves.csv, fit.json, check.json"));
  bake("out");
  expect_refusal("report map.exr", HasSubstr("map.exr: is not a folder"));
  expect_refusal("report out -o page.txt", HasSubstr("page.txt: cannot write '.txt' files, expected .html"));
  expect_refusal("report out -o nowhere/page.html", HasSubstr("nowhere/page.html: could not write"));
  expect_refusal("report out -o /dev/full", HasSubstr("/dev/full"));
  for (const char* albedo : {"0.5", "0.5,0.5", "0.5,0.5,1.5", "0.5,0.5,nan", "0.5,0.5,0.5,0.5", "red"})
    expect_refusal(fmt::format("report out --albedo {}", albedo), HasSubstr("--albedo"));
  expect_refusal("report out --image-size 0", HasSubstr("--image-size"));
  // On a full disk no part of the page is left.
  expect_refusal("report out", HasSubstr("out/report.html: could not write"), "trap '' XFSZ; ulimit -f 64; ");

  std::filesystem::resize_file(folder_ / "out/bake.exr", 3000);
  expect_refusal("report out", HasSubstr("out/bake.exr"));
  std::filesystem::remove(folder_ / "out/bake.exr");
  std::ofstream(folder_ / "out/check.json") << "{\"passed\": tr";
  expect_refusal("report out", HasSubstr("out/check.json"));
  std::ofstream(folder_ / "out/check.json") << "{\"passed\": true}";
  expect_refusal("report out", HasSubstr("out/check.json: has no list \"checks\", expected one"));
  std::filesystem::remove(folder_ / "out/check.json");
  std::ofstream(folder_ / "out/trade.json") << "[1]";
  expect_refusal("report out", HasSubstr("out/trade.json: is not an object"));
}

TEST(ReportWithoutNode, SaysSo) {
  if (!page_template().empty()) GTEST_SKIP() << "this build has a report";
  const CommandResult result = run_hemibake("report .");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.standard_error,
            "hemibake: report: this build has no report, expected one made with Node and npm\n");
}

}  // namespace
}  // namespace hemibake
