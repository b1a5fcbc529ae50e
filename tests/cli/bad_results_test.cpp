// Refusal of files that claim to be bakes, curves or fits, or hold impossible values.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cli/run_hemibake.h"
#include "io/bake_file.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class BadResults : public CliTest {
 protected:
  void make_bake() const {
    write_map("map.exr", SyntheticKind::kShapes, 32, 32);
    run_well("bake map.exr -o bake.exr --rays 64 --amplitude 0.4");
  }
  // Writes the bake with one fault in it.
  void write_changed(const std::string& name, const std::function<void(BakeFile&)>& change) const {
    BakeFile file = read_bake(folder_ / "bake.exr");
    change(file);
    write_bake(folder_ / name, file.bake, file.provenance);
  }
  // Expects that `quantity` is judged and fails.
  void expect_failed_check(const std::string& arguments, const std::string& quantity) const {
    const CommandResult result = run("check " + arguments);
    EXPECT_EQ(result.exit_code, 1) << arguments;
    EXPECT_EQ(result.standard_error, "") << arguments;
    EXPECT_THAT(result.standard_output, testing::ContainsRegex("FAILED  " + quantity)) << arguments;
  }
};

TEST_F(BadResults, NoBake) {
  write_map("map.exr", SyntheticKind::kNoise, 16, 16);
  write_bytes(folder_ / "text.exr", "no bake\n");
  for (const std::string command : {"check {}", "curves {} -o c.csv"}) {
    const auto with = [&](const char* name) { return fmt::format(fmt::runtime(command), name); };
    expect_refusal(with("none.exr"), StartsWith("none.exr: No such file or directory"));
    expect_refusal(with("text.exr"), StartsWith("text.exr: "));
    expect_refusal(with("map.exr"), AllOf(StartsWith("map.exr: "), HasSubstr("expected")));
  }
}

TEST_F(BadResults, BakesWithoutWhatIsAsked) {
  write_map("map.exr", SyntheticKind::kShapes, 16, 16);
  run_well("bake map.exr -o ao.exr --rays 4 --outputs ao,normal");
  expect_refusal("check ao.exr", "ao.exr: holds no irradiance, expected some: nothing else is checked");
  expect_refusal("curves ao.exr -o c.csv", AllOf(StartsWith("ao.exr: "), HasSubstr("irradiance")));
}

TEST_F(BadResults, BakesThatCannotBe) {
  make_bake();
  run_well("check bake.exr");
  write_changed("bright.exr", [](BakeFile& file) {
    for (auto& plane : file.bake.irradiance)
      for (float& value : plane.values) value = std::min(1.1f * value, 3.14f);
  });
  expect_failed_check("bright.exr", "stored bounces above the sum");
  write_changed("dark.exr", [](BakeFile& file) {
    for (float& value : file.bake.total.values) value *= 0.99f;
  });
  expect_failed_check("dark.exr", R"(energy sum/pi \+ residual)");
  // Changes one texel of 1024.
  write_changed("blind.exr", [](BakeFile& file) { file.bake.visible_fraction(3, 2) = 0.001f; });
  expect_failed_check("blind.exr", R"(E0/pi above ao\(2-ao\), worst texel .* texel 3,2)");
  write_changed("rows.exr", [](BakeFile& file) { file.provenance["row_sum_error"] = 1e-3; });
  expect_failed_check("rows.exr", "link rows");
  expect_failed_check("bake.exr --tolerance 1e-12", "energy sum/pi, worst texel");

  const CommandResult json = run("check dark.exr --json");
  EXPECT_EQ(json.exit_code, 1);
  EXPECT_EQ(nlohmann::json::parse(json.standard_output).at("passed"), false);
}

TEST_F(BadResults, AttributesThatAreNone) {
  make_bake();
  for (const std::string name : {"converge", "row_sum_error"}) {
    write_changed("odd.exr", [&](BakeFile& file) { file.provenance[name] = "soon"; });
    expect_refusal("check odd.exr",
                   AllOf(StartsWith("odd.exr: attribute hemibake:" + name + " is \"soon\", expected")));
  }
}

// What a bake records passes what the command line passes.
TEST_F(BadResults, RecordedOptionsOutOfRange) {
  make_bake();
  const auto expect_bad = [&](const std::string& key, const nlohmann::ordered_json& value) {
    write_changed("odd.exr", [&](BakeFile& file) { file.provenance[key] = value; });
    expect_refusal("render odd.exr -o out --sun 30,40,1 --pictures light",
                   AllOf(StartsWith("odd.exr: "), HasSubstr(key.substr(0, key.find('_')))));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out/render.json"));
  };
  expect_bad("rays", 0);
  expect_bad("rays", -3);
  expect_bad("rays", 1e300);
  expect_bad("rays", 2000000000);
  expect_bad("rays", "many");
  expect_bad("rays", true);
  expect_bad("cone_degrees", -1e9);
  expect_bad("cone_degrees", 0.0);
  expect_bad("seed", -1);
  expect_bad("seed", 0.5);
  expect_bad("size_m", 0);
  expect_bad("size_m", -1.0);
  expect_bad("amplitude_m", -1e30);
  expect_bad("filter_radius", -5);
  expect_bad("filter_radius", 4000);
  expect_bad("tracer", "x");
  expect_bad("edge", "x");
  expect_bad("patches", "");
  expect_bad("outputs", "ao,x");
  expect_bad("bounces", -1);
  expect_bad("bounce_albedo", 1);
  expect_bad("normals", "of nothing");
}

TEST_F(BadResults, RecordedOptionsThatExcludeEachOther) {
  make_bake();
  write_changed("odd.exr", [](BakeFile& file) {
    file.provenance["tracer"] = "march";
    for (const char* key : {"max_steps", "lift_percent"}) file.provenance[key] = 1;
    for (const char* key : {"ray_set", "lookup"}) file.provenance[key] = "published";
    file.provenance["normalize"] = "exact";
    file.provenance["normal_length"] = "unit";
  });
  expect_refusal("render odd.exr -o out --sun 30,40,1 --pictures light",
                 StartsWith("odd.exr: what it records goes not together: patches: a march knows no facets"));
}

TEST_F(BadResults, BakesWithNaN) {
  std::vector<float> texels(2 * 20, 0.5f);
  texels[2 * 13 + 1] = std::nanf("");  // irradiance.00 of texel 3,2
  const std::string path = (folder_ / "nan.exr").string();
  OIIO::ImageSpec spec(5, 4, 2, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"ao", "irradiance.00"};
  spec.attribute("hemibake:provenance", R"({"version": "test"})");
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output && output->open(path, spec) &&
              output->write_image(OIIO::TypeDesc::FLOAT, texels.data()));
  ASSERT_TRUE(output->close());
  const auto line =
      AllOf(StartsWith("nan.exr: "), HasSubstr("irradiance.00"), HasSubstr("3,2"), HasSubstr("finite"));
  expect_refusal("check nan.exr", line);
  expect_refusal("curves nan.exr -o c.csv", line);
}

TEST_F(BadResults, HostileCurves) {
  const std::string head = "bin,ao_low,ao_high,ao_mean,count,E00_mean,E00_stddev,E01_mean,E01_stddev\n";
  const auto expect_bad = [&](const std::string& bytes, const testing::Matcher<std::string>& line) {
    write_bytes(folder_ / "c.csv", bytes);
    expect_refusal("fit c.csv -o f.json", AllOf(StartsWith("c.csv:"), HasSubstr("expected"), line));
    expect_refusal("check c.csv", AllOf(StartsWith("c.csv:"), HasSubstr("expected"), line));
  };
  expect_bad("", "c.csv: is empty, expected a line of column names");
  expect_bad(std::string(100000, '\0'), testing::_);
  expect_bad(std::string(100000, ','), testing::_);
  expect_bad(head + "0,0,1\n", HasSubstr("c.csv:2"));
  expect_bad(head + "0,0,0.5,0.2,4,1,0,inf,0\n",
             AllOf(HasSubstr("c.csv:2"), HasSubstr("E01_mean"), HasSubstr("finite")));
  expect_bad(head + "0,0,0.5,0.2,1e999,1,0,1,0\n", AllOf(HasSubstr("c.csv:2"), HasSubstr("count")));
  expect_bad(head + "0,0.5,0.2,0.2,1,1,0,1,0\n", HasSubstr("c.csv:2"));
}

TEST_F(BadResults, HostileFits) {
  const auto expect_bad = [&](const std::string& bytes) {
    write_bytes(folder_ / "f.json", bytes);
    expect_refusal("check f.json", AllOf(StartsWith("f.json"), HasSubstr("expected")));
  };
  expect_bad("");
  expect_bad("[]");
  expect_bad("{\"F0\": NaN}");
  expect_bad("{\"F0\": {\"model\": 1}}");
  expect_bad("{\"F0\": null");
  expect_bad(std::string(1000000, '['));
  expect_bad("{}");
  expect_bad(R"({"provenance": {}})");
  expect_bad("{\"provenance\":" + std::string(1000000, '[') + std::string(1000000, ']') + "}");
  write_bytes(folder_ / "f.txt", "{}");
  expect_refusal("check f.txt", StartsWith("f.txt: nothing to check by that name, expected"));
  expect_refusal("check none.json", StartsWith("none.json: could not read"));
  expect_refusal("check .", HasSubstr("expected"));
}

}  // namespace
}  // namespace hemibake
