#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/run_hemibake.h"
#include "io/image_io.h"
#include "surface/synthetic/synthetic.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(SynthCommand, WritesEveryKind) {
  const TemporaryFolder folder;
  for (const SyntheticKindInfo& kind : synthetic_kinds()) {
    const auto path = folder / (std::string(kind.name) + ".exr");
    const auto result =
        run_hemibake(std::string("synth ") + kind.name + " --width 24 --height 16 -o " + path.string());
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    EXPECT_EQ(result.standard_error, "");
    const SyntheticMap map = synthesize(kind.kind, {.width = 24, .height = 16, .seed = 1, .angle_rad = {}});
    EXPECT_EQ(read_height_map(path).values, map.heights.values) << kind.name;
  }
}

TEST(SynthCommand, SaysTheAmplitudeInJson) {
  const TemporaryFolder folder;
  const auto path = folder / "groove.exr";
  const auto result =
      run_hemibake("synth groove --angle 30 --width 64 --height 8 --json -o " + path.string());
  ASSERT_EQ(result.exit_code, 0) << result.standard_error;
  const auto json = nlohmann::json::parse(result.standard_output);
  // Walls 8 texels wide of 1/64 m, 30° off the vertical.
  EXPECT_NEAR(json.at("recommended_amplitude_m").get<double>(), 8.0 / 64 * std::sqrt(3.0), 1e-15);
  EXPECT_EQ(json.at("output"), path.string());
}

TEST(SynthCommand, WritesPngWithin16Bits) {
  const TemporaryFolder folder;
  const auto path = folder / "noise.png";
  ASSERT_EQ(run_hemibake("synth noise --width 32 --height 32 -o " + path.string()).exit_code, 0);
  const SyntheticMap map =
      synthesize(SyntheticKind::kNoise, {.width = 32, .height = 32, .seed = 1, .angle_rad = {}});
  const Grid<float> read = read_height_map(path);
  for (size_t i = 0; i < read.size(); ++i) ASSERT_NEAR(read[i], map.heights[i], 0.5 / 65535 + 1e-7);
}

TEST(SynthCommand, ExplainsItself) {
  const auto result = run_hemibake("synth --help");
  EXPECT_EQ(result.exit_code, 0);
  for (const SyntheticKindInfo& kind : synthetic_kinds())
    EXPECT_THAT(result.standard_output, AllOf(HasSubstr(kind.name), HasSubstr(kind.description)));
}

TEST(SynthCommand, RefusesBadInputInOneLine) {
  const TemporaryFolder folder;
  const std::string output = " -o " + (folder / "map.exr").string();
  for (const std::string& arguments : std::vector<std::string>{
           "brick" + output,
           "bricks",
           "bricks -o " + (folder / "map.txt").string(),
           "bricks -o " + (folder / "missing" / "map.exr").string(),
           "bricks --width 0" + output,
           "bricks --width 12abc" + output,
           "bricks --width 100000 --height 100000" + output,
           "bricks --width 99999999999" + output,
           "bricks --seed -1" + output,
           "bricks --angle 45" + output,
           "bowl --angle 90" + output,
           "bowl --angle nan" + output,
           "bowl --threads -1" + output,
       }) {
    const auto result = run_hemibake("synth " + arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.standard_output, "") << arguments;
    EXPECT_THAT(result.standard_error, StartsWith("hemibake: ")) << arguments;
    EXPECT_EQ(std::ranges::count(result.standard_error, '\n'), 1) << arguments << "\n"
                                                                  << result.standard_error;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace hemibake
