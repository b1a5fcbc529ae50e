// `--margin` through the real binary: the outer ring occludes and is cropped off every output.
#include <fmt/format.h>

#include "bake/crop.h"
#include "cli/run_hemibake.h"
#include "io/bake_file.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

class Margin : public CliTest {
 protected:
  void SetUp() override {
    write_map("map.exr", SyntheticKind::kTerrain, 24, 20);
    run_well("bake map.exr -o whole.exr --rays 8 --bounces 3 --edge ground");
    run_well("bake map.exr -o inner.exr --rays 8 --bounces 3 --edge ground --margin 5");
  }
};

TEST_F(Margin, LeavesTheInnerPartOfTheSameBake) {
  const Bake whole = read_bake(folder_ / "whole.exr").bake, inner = read_bake(folder_ / "inner.exr").bake;
  ASSERT_EQ(inner.width, 14);
  ASSERT_EQ(inner.height, 10);
  EXPECT_EQ(inner.visible_fraction.values, crop_plane(whole.visible_fraction, 5).values);
  EXPECT_EQ(inner.visibility.values, crop_plane(whole.visibility, 5).values);
  EXPECT_EQ(inner.total.values, crop_plane(whole.total, 5).values);
}

TEST_F(Margin, TexturesOfMapAndOfBakeAreAlike) {
  run_well(
      "textures map.exr -o of_map --maps ao,svf,horizon:4 --format exr --rays 8 --edge ground --margin 5 "
      "--azimuths 16");
  run_well("textures inner.exr -o of_bake --maps ao,svf,horizon:4 --format exr --azimuths 16");
  run_well("textures whole.exr -o of_whole --maps ao,svf,horizon:4 --format exr --azimuths 16");
  const auto read = [&](const std::string& name, const std::string& channel = "") {
    return read_height_map(folder_ / name, channel);
  };
  for (const char* name : {"ao", "svf"}) {
    const auto values = read(fmt::format("of_map/map_{}.exr", name)).values;
    EXPECT_EQ(values, read(fmt::format("of_bake/inner_{}.exr", name)).values) << name;
    EXPECT_EQ(values, crop_plane(read(fmt::format("of_whole/whole_{}.exr", name)), 5).values) << name;
  }
  EXPECT_EQ(read("of_map/map_horizon.exr", "horizon.090").values,
            crop_plane(read("of_whole/whole_horizon.exr", "horizon.090"), 5).values);
}

TEST_F(Margin, BakeServesCheckCurvesReportAndRender) {
  run_well("check inner.exr");
  run_well("curves inner.exr -o curves.csv");
  const nlohmann::json made = run_json("render inner.exr -o pictures --pictures planes,estimators,views");
  bool estimators = false;
  for (const auto& missing : made.at("missing")) {
    const std::string text = missing.dump();
    EXPECT_EQ(text.find("was not found"), std::string::npos) << text;
    estimators = estimators || text.find("the bake is cropped") != std::string::npos;
  }
  EXPECT_TRUE(estimators);
  EXPECT_TRUE(std::filesystem::is_regular_file(folder_ / "pictures/view_ao_only.png"));
  expect_refusal("render inner.exr -o lit --sun 120,40,1",
                 testing::HasSubstr("is cropped by 5 texels, expected a bake of the whole map"));
}

}  // namespace
}  // namespace hemibake
