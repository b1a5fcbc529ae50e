// Extreme maps: one texel, one row, flat, nearly flat, absurdly high, few bits.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/run_hemibake.h"
#include "core/constants.h"
#include "io/bake_file.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

class Extremes : public CliTest {
 protected:
  // Reading refuses every value that is not finite.
  Bake bake(const std::string& arguments) const {
    run_well("bake " + arguments + " -o bake.exr");
    return read_bake(folder_ / "bake.exr").bake;
  }
};

TEST_F(Extremes, OneTexelAndOneRow) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 2}}) {
    Grid<float> heights(width, height);
    for (size_t i = 0; i < heights.size(); ++i) heights[i] = i % 3 == 0 ? 1.0f : 0.0f;
    write_map("map.exr", heights);
    for (const std::string patches : {"facets", "texels"}) {
      const Bake result = bake("map.exr --rays 64 --amplitude 0.5 --converge 1e-5 --patches " + patches);
      EXPECT_EQ(result.width, width);
      EXPECT_EQ(result.height, height);
      if (width * height == 1) {
        EXPECT_EQ(result.visible_fraction[0], 1);
      }
      if (patches == "texels") continue;
      for (const float total : result.total.values)
        EXPECT_NEAR(static_cast<double>(total) / kPi, 1, 2e-5) << width << "x" << height;
    }
  }
}

// Flat ground: only sky, no bounces, a single AO value and so no curve to fit.
TEST_F(Extremes, FlatGround) {
  write_map("flat.exr", SyntheticKind::kFlat, 32, 32);
  write_map("shapes.exr", SyntheticKind::kShapes, 32, 32);
  for (const std::string map : {"flat.exr", "shapes.exr --amplitude 0"}) {
    fs::create_directory(folder_ / "results");
    write_bytes(folder_ / "results/fit.json", "{\"of\": \"an earlier run\"}");
    const CommandResult result = run("run " + map + " -o results --rays 16 --json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_THAT(result.standard_error,
                testing::EndsWith("hemibake: " + map.substr(0, map.find(' ')) +
                                  ": no fit: 1 usable bins, expected at least 3 for the 2 parameters of "
                                  "published F0\n"));
    // Heights that are all alike are warned of, unless the amplitude makes them so.
    EXPECT_EQ(result.standard_error.find("warning: ") != std::string::npos, map == "flat.exr");
    const auto json = nlohmann::json::parse(result.standard_output);
    EXPECT_TRUE(json.at("fits").is_null());
    EXPECT_TRUE(json.at("check").at("passed"));
    EXPECT_FALSE(fs::exists(folder_ / "results/fit.json"));
    const Bake made = read_bake(folder_ / "results/bake.exr").bake;
    for (const float ao : made.visible_fraction.values) ASSERT_EQ(ao, 1);
    for (const float direct : made.irradiance[0].values) ASSERT_FLOAT_EQ(direct, static_cast<float>(kPi));
    for (const float first : made.irradiance[1].values) ASSERT_EQ(first, 0);
    run_well("check results/bake.exr --tolerance 1e-6");
    run_well("check results/curves.csv --tolerance 1e-6");
    EXPECT_TRUE(nlohmann::json::parse(read_bytes(folder_ / "results/check.json")).at("passed"));
  }
}

TEST_F(Extremes, LowAndHigh) {
  write_map("map.exr", SyntheticKind::kShapes, 32, 32);
  // A micrometre over a metre: the sky is whole to 10⁻⁵, except for the one or two of 64 rays along the
  // ground.
  const Bake low = bake("map.exr --amplitude 1e-6 --rays 64");
  for (const float ao : low.visible_fraction.values) EXPECT_GT(ao, 1 - 3.0 / 64);
  // A kilometre: walls of 89.998°. All values are finite, and no texel gets more light than the sky gives.
  const CommandResult high = run("run map.exr -o high --amplitude 1e3 --rays 64");
  EXPECT_THAT(high.exit_code, testing::AnyOf(0, 1)) << high.standard_error;
  const BakeFile made = read_bake(folder_ / "high/bake.exr");
  for (size_t i = 0; i < made.bake.total.size(); ++i) {
    EXPECT_LE(made.bake.total[i], static_cast<float>(kPi) * 1.000001f);
    EXPECT_NEAR(static_cast<double>(made.bake.total[i]) / kPi + static_cast<double>(made.bake.residual[i]), 1,
                2e-6);
  }
  EXPECT_LT(made.provenance.at("row_sum_error").get<double>(), 1e-5);
}

// The same 256 heights in 8 bits, 16 bits and floats.
TEST_F(Extremes, BitDepths) {
  constexpr int kSide = 32;
  std::vector<uint8_t> bytes;
  const Grid<float> shapes =
      synthesize(SyntheticKind::kNoise, {.width = kSide, .height = kSide, .seed = 1, .angle_rad = {}})
          .heights;
  Grid<float> floats(kSide, kSide);
  for (size_t i = 0; i < shapes.size(); ++i) {
    bytes.push_back(static_cast<uint8_t>(std::lround(255 * shapes[i])));
    floats[i] = static_cast<float>(bytes.back()) / 255;
  }
  const std::string path = (folder_ / "8.png").string();
  const auto output = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(output && output->open(path, OIIO::ImageSpec(kSide, kSide, 1, OIIO::TypeDesc::UINT8)));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT8, bytes.data()));
  ASSERT_TRUE(output->close());
  write_map("16.png", floats);
  write_map("float.exr", floats);

  const Bake reference = bake("float.exr --rays 64 --outputs ao --amplitude 0.3");
  for (const std::string map : {"8.png", "16.png"}) {
    const Bake other = bake(map + " --rays 64 --outputs ao --amplitude 0.3");
    for (size_t i = 0; i < shapes.size(); ++i)
      // Heights equal to rounding can move one ray that grazes an edge.
      ASSERT_NEAR(other.visible_fraction[i], reference.visible_fraction[i], 1.01 / 64) << map << " " << i;
  }
}

class Converge : public CliTest {
 protected:
  void expect_pi_everywhere(const std::string& arguments) const {
    run_well("bake " + arguments + " -o bake.exr --converge 1e-5");
    const Bake bake = read_bake(folder_ / "bake.exr").bake;
    for (size_t i = 0; i < bake.total.size(); ++i)
      ASSERT_NEAR(static_cast<double>(bake.total[i]) / kPi, 1, 2e-5) << arguments << " texel " << i;
    run_well("check bake.exr");
  }
};

TEST_F(Converge, FacetsFillEveryTexel) {
  for (const SyntheticKind kind : {SyntheticKind::kBricks, SyntheticKind::kShapes, SyntheticKind::kNoise,
                                   SyntheticKind::kFlat, SyntheticKind::kGroove}) {
    write_map("map.exr", kind, 64, 64);
    expect_pi_everywhere("map.exr --rays 64");
  }
}

TEST_F(Converge, TexelsFillSmoothMaps) {
  for (const SyntheticKind kind : {SyntheticKind::kFlat, SyntheticKind::kGroove}) {
    write_map("map.exr", kind, 64, 64);
    expect_pi_everywhere("map.exr --rays 64 --patches texels");
  }
}

TEST_F(Converge, TexelsLeftShortAreNamedInOneLine) {
  write_map("map.exr", SyntheticKind::kNoise, 64, 64);
  // 64 rays leave some texels no way out of their pit; slices find one.
  const CommandResult result = run_well(
      "bake map.exr -o bake.exr --tracer embree --amplitude 1 --rays 64 --patches texels --converge 1e-5 "
      "--max-bounces 200");
  EXPECT_THAT(
      result.standard_error,
      testing::ContainsRegex("^hemibake: map.exr: warning: [0-9]+ texels are short of 1e-05 after 200 "
                             "bounces, the worst by (1|0\\.[0-9]+): [0-9]+,[0-9]+"));
  EXPECT_EQ(std::ranges::count(result.standard_error, '\n'), 1) << result.standard_error;
}

TEST_F(Converge, FacetsFillThePublishedWall) {
  const fs::path wall = fs::path(HEMIBAKE_REFERENCE_DIR) / "WallHeight.png";
  if (!fs::exists(wall)) GTEST_SKIP() << wall << " is not there";
  expect_pi_everywhere(fmt::format("'{}' --rays 32", wall.string()));
}

}  // namespace
}  // namespace hemibake
