// `hemibake export` and `hemibake compare` through the real binary.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/constants.h"
#include "io/curves_file.h"
#include "io/io_testing.h"
#include "model/model.h"
#include "support/run_command.h"

namespace hemibake {
namespace {

constexpr BoundedModel kModel{0.4, 0.9, 0.6, 0.8};

class Export : public testing::Test {
 protected:
  void SetUp() override {
    Curves curves;
    curves.bounce_count = 4;
    for (int j = 0; j < 50; ++j) {
      CurveBin bin{j / 50.0, (j + 1) / 50.0, (j + 0.5) / 50, 10, {}};
      const double ao = bin_center(bin);
      bin.bounces.push_back({kPi * kModel.direct(ao), 0});
      double bounce = kPi * kModel.first_bounce(ao);
      for (int b = 1; b < 4; ++b, bounce *= kModel.bounce_ratio(ao)) bin.bounces.push_back({bounce, 0});
      curves.bins.push_back(bin);
    }
    write_curves(folder_ / "c.csv", curves);
    ASSERT_EQ(run("fit c.csv -o f.json").exit_code, 0);
  }

  CommandOutcome run(const std::string& arguments) const {
    return run_command(fmt::format("cd '{}' && '{}' {}", folder_.path().string(), HEMIBAKE_BINARY, arguments),
                       folder_.path());
  }

  void expect_failure(const std::string& arguments, const std::string& line) const {
    const CommandOutcome outcome = run(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.err, "hemibake: " + line + "\n");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out.txt"));
  }

  TemporaryFolder folder_;
};

TEST_F(Export, EveryLanguageAndModel) {
  for (const std::string language : {"glsl", "hlsl", "cpp"}) {
    for (const std::string model : {"bounded", "published"}) {
      const CommandOutcome outcome =
          run(fmt::format("export f.json --to {} --model {} -o out.txt --json", language, model));
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_EQ(nlohmann::json::parse(outcome.out).at("model"), model);
      const std::string text = read_bytes(folder_ / "out.txt");
      EXPECT_NE(text.find("multi_bounce_irradiance(float ao, "), std::string::npos);
      EXPECT_NE(text.find("// input: c.csv\n"), std::string::npos);
    }
  }
}

TEST_F(Export, TableHoldsTheModel) {
  ASSERT_EQ(run("export f.json --to csv -o t.csv").exit_code, 0);
  const Table table = read_csv(folder_ / "t.csv");
  ASSERT_EQ(table.rows.size(), 101U);
  const size_t half = find_column(table, "total_0.5").value();
  const size_t ratio = find_column(table, "bounce_ratio").value();
  for (const auto& row : table.rows) {
    EXPECT_NEAR(row[half].value(), kModel.total(row[0].value(), 0.5), 1e-6);
    EXPECT_NEAR(row[ratio].value(), kModel.bounce_ratio(row[0].value()), 1e-6);
  }
}

TEST_F(Export, UnusableFitsAreRefused) {
  ASSERT_EQ(run("fit c.csv -o published.json --model published").exit_code, 0);
  expect_failure("export published.json --to glsl -o out.txt",
                 "published.json: no fit bounded_F0, expected the fits of model 'bounded'");
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_bytes(folder_ / "f.json"));
  json["bounded_tau"]["parameters"]["q"]["value"] = 1.5;
  write_bytes(folder_ / "bad.json", json.dump());
  expect_failure("export bad.json --to glsl -o out.txt",
                 "bad.json: q of bounded tau is 1.5, expected 1e-06 to 1");
  json["bounded_tau"]["parameters"].erase("q");
  write_bytes(folder_ / "bad.json", json.dump());
  expect_failure("export bad.json --to glsl -o out.txt",
                 "bad.json: bounded tau has no parameter q, expected one");
  expect_failure("export c.csv --to glsl -o none/out.txt",
                 "none/out.txt: could not write: No such file or directory");
}

TEST_F(Export, CompareRanksTheRightModelFirst) {
  const CommandOutcome outcome = run("compare c.csv c.csv --json");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const nlohmann::json& model : nlohmann::json::parse(outcome.out).at("models")) {
    const double own = model.at("errors").at(0).at("own").at("rms");
    EXPECT_EQ(own < 1e-6, model.at("model") == "bounded") << model;
  }
}

}  // namespace
}  // namespace hemibake
