// Many maps in one call of `hemibake bake`, `run` and `textures`.
#include <fstream>

#include "cli/run_hemibake.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Batch : public CliTest {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ / "maps");
    write_map("maps/a.exr", SyntheticKind::kBricks, 12, 12);
    write_map("maps/b.exr", SyntheticKind::kNoise, 12, 10);
    write_map("maps/d.exr", SyntheticKind::kFlat, 8, 8);
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }
  std::string bytes(const std::string& name) const { return read_bytes(folder_ / name); }
};

TEST_F(Batch, EachMapIsBakedAsByItself) {
  run_well("bake maps -o out --rays 8 --bounces 3");
  run_well("bake maps/a.exr -o a.exr --rays 8 --bounces 3");
  for (const char* name : {"out/a.exr", "out/b.exr", "out/d.exr"}) EXPECT_TRUE(exists(name)) << name;
  const auto json = run_json("bake maps/a.exr maps/b.exr -o out2 --rays 8 --bounces 3");
  ASSERT_EQ(json.at("maps").size(), 2u);
  EXPECT_EQ(json.at("maps")[1].at("output"), "out2/b.exr");
  const auto one = run_json("bake maps/b.exr -o one.exr --rays 8 --bounces 3");
  EXPECT_EQ(one.at("mean_visibility"), json.at("maps")[1].at("mean_visibility"));
}

TEST_F(Batch, ABadMapIsNamedAndStopsNoOther) {
  std::ofstream(folder_ / "maps/c.png") << "no picture";
  const CommandResult result = run("bake maps -o out --rays 8 --outputs ao");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.standard_error,
              AllOf(HasSubstr("maps/c.png: "), HasSubstr("1 of 4 maps were bad: maps/c.png")));
  EXPECT_TRUE(exists("out/a.exr") && exists("out/b.exr") && exists("out/d.exr"));
  EXPECT_FALSE(exists("out/c.exr"));
}

TEST_F(Batch, WhatIsDoneIsSkippedUnlessSomethingChanged) {
  run_well("bake maps -o out --rays 8 --outputs ao");
  const CommandResult again = run("bake maps -o out --rays 8 --outputs ao");
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.standard_output,
              AllOf(HasSubstr("[1/3] maps/a.exr: done before"), HasSubstr("[3/3] maps/d.exr: done before")));
  const CommandResult other = run("bake maps -o out --rays 4 --outputs ao");
  EXPECT_THAT(other.standard_output, Not(HasSubstr("done before")));
  write_map("maps/a.exr", SyntheticKind::kShapes, 12, 12);
  const CommandResult changed = run("bake maps -o out --rays 4 --outputs ao");
  EXPECT_THAT(changed.standard_output,
              AllOf(Not(HasSubstr("a.exr: done before")), HasSubstr("b.exr: done before")));
}

TEST_F(Batch, RunMakesAFolderAMapThatFitTakes) {
  const CommandResult result = run("run maps/a.exr maps/b.exr -o out --rays 16");
  EXPECT_LE(result.exit_code, 1) << result.standard_error;  // a check may fail on so small a map
  for (const char* name : {"out/a/bake.exr", "out/a/curves.csv", "out/b/check.json"})
    EXPECT_TRUE(exists(name));
  EXPECT_THAT(run("run maps/a.exr maps/b.exr -o out --rays 16").standard_output,
              HasSubstr("[2/2] maps/b.exr: done"));
  run_well("fit out -o fit.json --model visibility");
}

TEST_F(Batch, TexturesOfEachMapAreThoseOfTheMapByItself) {
  run_well("textures maps -o out --maps ao --rays 8");
  run_well("textures maps/b.exr -o one --maps ao --rays 8");
  const ImageHeader header = read_image_header(folder_ / "out/b_ao.png");
  EXPECT_EQ(header.width, 12);
  std::vector<float> many(120), one(120);
  for (const auto& [file, values] : {std::pair("out/b_ao.png", &many), std::pair("one/b_ao.png", &one)}) {
    const MutablePlane plane{"Y", values->data()};
    read_planes(folder_ / file, 12, 10, {&plane, 1});
  }
  EXPECT_EQ(many, one);
}

TEST_F(Batch, TexturesThatAreDoneAreSkippedUnlessSomethingChanged) {
  const auto skipped = [&](const std::string& arguments) {
    const CommandResult result = run("textures " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.standard_error;
    size_t count = 0;
    for (size_t at = 0; (at = result.standard_output.find("done before", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  for (const char* format : {"png8", "png16", "exr", "tif"}) {
    const std::string call = "maps -o out --maps visibility --rays 8 --format " + std::string(format);
    EXPECT_EQ(skipped(call), 0u);
    EXPECT_EQ(skipped(call), 3u) << format;
  }
  EXPECT_EQ(skipped("maps -o out --maps visibility,ao --rays 8 --format tif"), 0u);
  EXPECT_EQ(skipped("maps -o out --maps visibility,ao --rays 4 --format tif"), 0u);
  write_map("maps/a.exr", SyntheticKind::kShapes, 12, 12);
  EXPECT_EQ(skipped("maps -o out --maps visibility,ao --rays 4 --format tif"), 2u);
}

TEST_F(Batch, TexturesOfAFolderOfBakesLieBesideThem) {
  run_well("bake maps -o out --rays 8 --bounces 3");
  const std::string call = "textures out -o out --maps irradiance --format exr --albedo ";
  EXPECT_THAT(run(call + "0.3").standard_output, HasSubstr("[3/3] out/d.exr ->"));
  EXPECT_THAT(run(call + "0.3").standard_output, HasSubstr("[3/3] out/d.exr: done before"));
  EXPECT_THAT(run(call + "0.4").standard_output, HasSubstr("[3/3] out/d.exr ->"));
  EXPECT_EQ(run("textures out -o out --rays 8").exit_code, 2);
}

TEST_F(Batch, RefusesWhatIsOfOneMap) {
  std::filesystem::create_directory(folder_ / "empty");
  std::filesystem::create_directory(folder_ / "other");
  write_map("other/a.exr", SyntheticKind::kFlat, 4, 4);
  expect_refusal("bake empty -o out", HasSubstr("empty: a folder without images"));
  expect_refusal("bake maps other/a.exr -o out", HasSubstr("has the name of"));
  expect_refusal("bake maps -o out --links l.h5", HasSubstr("--links: is of one map"));
  expect_refusal("bake maps", HasSubstr("--output"));
  expect_refusal("textures empty -o out", HasSubstr("empty: a folder without images"));
  expect_refusal("textures maps other/a.exr -o out", HasSubstr("has the name of"));
  expect_refusal("textures maps -o out --normals n.png --normals-y up",
                 HasSubstr("--normals: is of one map"));
  expect_refusal("textures maps -o out --engine unreal --roughness other/a.exr",
                 HasSubstr("other/a.exr: is of one map"));
}

}  // namespace
}  // namespace hemibake
