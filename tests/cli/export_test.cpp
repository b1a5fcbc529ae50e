// `hemibake export` and `hemibake compare` through the real binary.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
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
  for (const std::string language : {"glsl", "hlsl", "wgsl", "msl", "osl", "cpp"}) {
    for (const std::string model : {"visibility", "visibility-normal", "visibility-ao", "visibility-ao-mean",
                                    "bounce-map", "bounded", "published", "jimenez"}) {
      const bool fitted = model == "bounded" || model == "published" || model == "visibility-ao-mean";
      const CommandOutcome outcome = run(fmt::format("export {} --to {} --model {} -o out.txt --json",
                                                     fitted ? "f.json" : "none", language, model));
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_EQ(nlohmann::json::parse(outcome.out).at("model"), model);
      const std::string text = read_bytes(folder_ / "out.txt");
      EXPECT_NE(text.find("multi_bounce"), std::string::npos);
      EXPECT_EQ(text.find("// input: c.csv\n") != std::string::npos, fitted);
      // Nothing of the maker's machine.
      for (const char* private_word : {"sha256", "command", "hemibake fit", "hemibake run", "/tmp"})
        EXPECT_EQ(text.find(private_word), std::string::npos) << text;
    }
  }
}

TEST_F(Export, LanguageFollowsFromTheName) {
  const std::map<std::string, std::string> names = {
      {"a.frag", "glsl"}, {"a.GLSL", "glsl"},  {"a.gdshaderinc", "glsl"}, {"a.hlsl", "hlsl"},
      {"a.ush", "hlsl"},  {"a.cginc", "hlsl"}, {"a.wgsl", "wgsl"},        {"a.metal", "msl"},
      {"a.osl", "osl"},   {"a.h", "cpp"},      {"a.hpp", "cpp"},          {"a.csv", "csv"}};
  for (const auto& [name, language] : names) {
    const CommandOutcome outcome = run("export none --model visibility-ao --json -o " + name);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(outcome.out).at("to"), language) << name;
  }
  EXPECT_EQ(run("export none --model visibility-ao --to msl -o metal.h").exit_code, 0);
  expect_failure(
      "export none --model visibility-ao -o out.txt",
      "out.txt: its name says no language, expected a name such as model.glsl, or --to with one of "
      "glsl, hlsl, wgsl, msl, osl, cpp, csv");
  expect_failure("export none --model visibility-ao --to hlsl -o out.glsl",
                 "out.glsl: its name says glsl, but --to says hlsl; expected one of them, or both the same");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out.glsl"));
}

TEST_F(Export, ConstantsAreThoseOfTheFit) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_bytes(folder_ / "f.json"));
  json["visibility"] = json["bounded_tau"];
  json["visibility"]["parameters"] = {{"dark", {{"value", 0.0625}, {"stderr", 0.01}}},
                                      {"open", {{"value", 0.8125}, {"stderr", nullptr}}}};
  json["visibility_ao"] = json["visibility"];
  json["provenance"]["bounce_albedo"] = 0.875;
  write_bytes(folder_ / "v.json", json.dump());
  for (const std::string model : {"visibility", "visibility-ao"}) {
    ASSERT_EQ(run("export v.json -o v.glsl --model " + model).exit_code, 0);
    EXPECT_NE(read_bytes(folder_ / "v.glsl").find("const float hemibake_dark = 0.0625;"), std::string::npos);
    ASSERT_EQ(run("export v.json -o v.glsl --constants none --model " + model).exit_code, 0);
    EXPECT_EQ(read_bytes(folder_ / "v.glsl").find("hemibake_dark"), std::string::npos);
  }
  ASSERT_EQ(run("export f.json -o v.glsl --model visibility-ao").exit_code, 0);  // needs no fit
  const auto albedo_of = [&](const std::string& arguments) {
    EXPECT_EQ(run("export " + arguments + " -o m.glsl --model bounce-map").exit_code, 0);
    const std::string text = read_bytes(folder_ / "m.glsl"), name = "hemibake_bounce_albedo = ";
    return std::stod(text.substr(text.find(name) + name.size()));
  };
  EXPECT_EQ(albedo_of("v.json"), 0.875);
  EXPECT_EQ(albedo_of("none"), 0.9);
  EXPECT_EQ(albedo_of("v.json --bounce-albedo 0.5"), 0.5);
}

// m is that of the map; of several their mean, or that of the one named; or a given number.
TEST_F(Export, MeanEscapeIsThatOfTheMap) {
  const nlohmann::json single = nlohmann::json::parse(read_bytes(folder_ / "f.json"));
  nlohmann::ordered_json several = single;
  several["maps"] = {{{"map", "wall"}, {"mean_escape", 0.25}},
                     {{"map", "floor"}, {"mean_escape", 0.5}},
                     {{"map", "unknown"}, {"mean_escape", nullptr}}};
  write_bytes(folder_ / "s.json", several.dump());
  const auto expect_text = [&](const std::string& arguments, double m, const std::string& line) {
    const CommandOutcome outcome = run("export " + arguments + " -o m.glsl --model visibility-ao-mean");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    const std::string text = read_bytes(folder_ / "m.glsl"), name = "hemibake_mean_escape = ";
    EXPECT_NEAR(std::stod(text.substr(text.find(name) + name.size())), m, 1e-8) << text;
    EXPECT_NE(text.find("// mean_escape: " + line + "\n"), std::string::npos) << text;
  };
  expect_text("f.json", single["maps"][0]["mean_escape"], "of c.");
  expect_text("s.json", 0.375, "the mean of wall, floor.");
  expect_text("s.json --map floor", 0.5, "of floor.");
  expect_text("s.json --mean-escape 0.125", 0.125, "as given.");
  expect_text("none --mean-escape 1", 1, "as given.");
  expect_text("s.json --constants none --mean-escape 0", 0, "as given.");
}

TEST_F(Export, MeanEscapeThatIsUnknownIsRefused) {
  const std::string wanted =
      "no mean escape share of a map, expected FIT.json as 'hemibake fit' writes it of a bake or of curves "
      "with counts, or --mean-escape";
  const std::string mean = " --model visibility-ao-mean --to glsl -o out.txt";
  expect_failure("export none" + mean, "none: " + wanted);
  expect_failure("export f.json --constants none" + mean, "f.json: " + wanted);
  expect_failure("export f.json --map d" + mean, "--map: no map 'd' in f.json, expected one of c");
  expect_failure("export f.json --map c --mean-escape 0.5" + mean,
                 "--map: --mean-escape gives the number already, expected one of them");
  expect_failure("export f.json --mean-escape 0.5 --to glsl -o out.txt",
                 "--mean-escape: the model bounded takes none, expected --model visibility-ao-mean");
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_bytes(folder_ / "f.json"));
  json["maps"][0]["mean_escape"] = 1.5;
  write_bytes(folder_ / "bad.json", json.dump());
  expect_failure("export bad.json" + mean,
                 "bad.json: maps/0/mean_escape is 1.5, expected a number from 0 to 1");
  json.erase("maps");
  write_bytes(folder_ / "old.json", json.dump());
  expect_failure("export old.json" + mean, "old.json: " + wanted);
}

// `check` judges each model that `export` makes of the file, and names what is on its bound.
TEST_F(Export, CheckJudgesTheEscapeModels) {
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(read_bytes(folder_ / "f.json"));
  json["visibility"]["parameters"]["dark"] = {{"value", 0}, {"stderr", nullptr}, {"on_bound", true}};
  write_bytes(folder_ / "c.json", json.dump());
  const CommandOutcome outcome = run("check c.json --json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
  std::map<std::string, std::string> details;
  const nlohmann::json checks = nlohmann::json::parse(outcome.out).at("checks");
  for (const nlohmann::json& check : checks) details[check.at("quantity")] = check.at("detail");
  const std::string m = fmt::format("{:.3g}", json["maps"][0]["mean_escape"].get<double>());
  for (const std::string& model :
       {std::string("visibility"), std::string("visibility-ao"), "visibility-ao-mean, m = " + m})
    for (const char* quantity : {"total outside [V, 1], worst", "total falls with albedo, worst",
                                 "off V at albedo 0, off 1 at albedo 1, worst"})
      EXPECT_TRUE(details.contains(model + ": " + quantity)) << model << ": " << quantity;
  EXPECT_EQ(details.at("visibility: dark and its error are numbers"), "on its bound");
  EXPECT_EQ(details.at("visibility: open and its error are numbers"), "");
  json["visibility_ao"]["parameters"]["open"]["value"] = 1.25;
  write_bytes(folder_ / "c.json", json.dump());
  const CommandOutcome refused = run("check c.json");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("c.json: open of visibility and ao is 1.25, expected 0 to 1"), std::string::npos)
      << refused.err;
}

TEST_F(Export, TablesOfTwoInputsAreLong) {
  ASSERT_EQ(run("export none --model visibility-ao -o t.csv").exit_code, 0);
  const Table table = read_csv(folder_ / "t.csv");
  ASSERT_EQ(table.rows.size(), 51U * 51U);
  EXPECT_EQ(table.columns[0], "visibility");
  EXPECT_EQ(table.columns[1], "ao");
  const size_t half = find_column(table, "total_0.5").value();
  for (const auto& row : table.rows)
    EXPECT_NEAR(row[half].value(), VisibilityAoModel{}.total(row[0].value(), row[1].value(), 0.5), 1e-12);
  ASSERT_EQ(run("export none --model bounce-map -o t.csv").exit_code, 0);
  EXPECT_EQ(read_csv(folder_ / "t.csv").columns[1], "bounce");
  ASSERT_EQ(run("export none --model visibility-normal -o t.csv").exit_code, 0);
  EXPECT_EQ(read_csv(folder_ / "t.csv").columns[1], "normal_z");
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
  json["bounded_tau"]["covariance"] = {{1e-6}};
  write_bytes(folder_ / "bad.json", json.dump());
  expect_failure("export bad.json --to glsl -o out.txt",
                 "bad.json: bounded tau has no parameter q, expected one");
  expect_failure("export published.json --model visibility --to glsl -o out.txt",
                 "published.json: no fit visibility, expected the fits of model 'visibility'");
  expect_failure("export none --to glsl -o out.txt",
                 "none: the model bounded has no constants without fits, expected FIT.json");
  expect_failure("export none --model visibility --bounce-albedo 0.8 --to glsl -o out.txt",
                 "--bounce-albedo: the model visibility has none, expected --model bounce-map");
  expect_failure("export none --model visibility --prefix 9a --to glsl -o out.txt",
                 "--prefix: '9a', expected letters, digits and underscores, and no digit at first");
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
