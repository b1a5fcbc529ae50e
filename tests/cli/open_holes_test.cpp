// Holes that stay open: no surface there, sky through them, no number in what is written.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>

#include "cli/run_hemibake.h"
#include "io/bake_file.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

class OpenHoles : public CliTest {
 protected:
  using Height = std::function<float(int x, int y)>;

  // Writes raw floats, metres over texels of 1 m, and returns the arguments that read them.
  std::string write_raw(int width, int height, const Height& value) {
    std::string bytes;
    holes_ = Grid<uint8_t>(width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const float h = value(x, y);
        holes_(x, y) = std::isnan(h);
        bytes.append(reinterpret_cast<const char*>(&h), sizeof h);
      }
    write_bytes(folder_ / "map.raw", bytes);
    return fmt::format("map.raw --raw {}x{}:f32le --heights metres --texel 1 --holes open", width, height);
  }

  // Bumps of up to 3 m, with a hole inside and one at the border.
  std::string write_bumps() {
    return write_raw(24, 20, [](int x, int y) {
      const bool inside = std::hypot(x - 9, y - 8) < 3.5, border = x >= 21 && y < 4;
      return inside || border ? kNone
                              : 1.5f + 1.5f * std::sin(0.9f * static_cast<float>(x) + 0.3f) *
                                           std::cos(0.7f * static_cast<float>(y));
    });
  }

  Bake bake(const std::string& arguments) {
    run_well("bake " + arguments + " -o b.exr");
    return read_bake(folder_ / "b.exr").bake;
  }

  void expect_nan_in_holes(const Grid<float>& plane, const char* name) {
    ASSERT_EQ(plane.size(), holes_.size()) << name;
    for (size_t i = 0; i < plane.size(); ++i)
      ASSERT_EQ(std::isnan(plane[i]), holes_[i] == 1) << name << ", texel " << i;
  }

  Grid<uint8_t> holes_;
};

TEST_F(OpenHoles, HaveNoNumbersAndAllElseHas) {
  const std::string map = write_bumps();
  for (const std::string edge : {"wrap", "open", "ground"}) {
    const Bake planes = bake(map + " --rays 64 --bounces 3 --edge " + edge);
    expect_nan_in_holes(planes.visible_fraction, "ao");
    expect_nan_in_holes(planes.visibility, "visibility");
    for (const Grid<float>& bounce : planes.irradiance) expect_nan_in_holes(bounce, "irradiance");
    expect_nan_in_holes(planes.total, "total");
    expect_nan_in_holes(planes.residual, "residual");
    for (size_t i = 0; i < holes_.size(); ++i) {
      EXPECT_EQ(std::isnan(planes.normals[i].x), holes_[i] == 1);
      EXPECT_EQ(std::isnan(planes.bent_normals[i].z), holes_[i] == 1);
    }
    EXPECT_EQ(run("check b.exr --tolerance 1").exit_code, 0);
  }
}

TEST_F(OpenHoles, GoAllTheWayToThePage) {
  const std::string map = write_bumps();
  run("run " + map + " --rays 64 -o out");
  const std::string curves = read_bytes(folder_ / "out/curves.csv");
  EXPECT_THAT(curves, testing::Not(HasSubstr("nan")));
  EXPECT_FALSE(curves.empty());
  run_well("report out -o page.html");
  run_well("render out/bake.exr -o pictures");
}

TEST_F(OpenHoles, AreTransparentInTextures) {
  const std::string map = write_bumps();
  run_well("textures " + map + " --rays 64 --maps visibility --format png16 -o t");
  bool found = false;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "t")) {
    if (entry.path().extension() != ".png") continue;
    found = true;
    const Grid<float> alpha = read_height_map(entry.path(), "A");
    for (size_t i = 0; i < holes_.size(); ++i) EXPECT_EQ(alpha[i], holes_[i] == 1 ? 0 : 1) << i;
  }
  EXPECT_TRUE(found);
}

TEST_F(OpenHoles, AFlatPlateSeesTheWholeSky) {
  const std::string map =
      write_raw(16, 16, [](int x, int y) { return x > 4 && x < 9 && y > 2 && y < 12 ? kNone : 0.0f; });
  for (const std::string edge : {"wrap", "open", "ground"}) {
    const Bake planes = bake(map + " --outputs ao --rays 64 --edge " + edge);
    for (size_t i = 0; i < holes_.size(); ++i)
      EXPECT_TRUE(holes_[i] == 1 || planes.visibility[i] == 1) << edge << ", texel " << i;
  }
}

// A canyon 32 m wide between plateaus 10 m high, tiled: E₀/π of the floor is (cos a₁ + cos a₂)/2, a the
// elevations of the plateaus' edges.
TEST_F(OpenHoles, AWallIsSeenAcrossAHoleAndNotWhereItIsNone) {
  const auto floor_of = [&](int hole_begin, int hole_end) {
    const std::string map = write_raw(64, 4, [&](int x, int) {
      return x >= hole_begin && x < hole_end ? kNone : x < 32 ? 0.0f : 10.0f;
    });
    return bake(map + " --outputs ao --rays 16384").visibility(10, 1);
  };
  const double left = std::cos(std::atan(10.0 / 11)), right = std::cos(std::atan(10.0 / 22));
  constexpr double kNoise = 2e-3;
  EXPECT_NEAR(floor_of(20, 26), (left + right) / 2, kNoise);  // in the floor
  EXPECT_NEAR(floor_of(20, 41), (left + 1) / 2, kNoise);      // the right wall and the edge over it
}

TEST_F(OpenHoles, TheSameBytesAtAnyThreadCount) {
  const std::string map = write_bumps();
  run_well("bake " + map + " --rays 64 -o one.exr --threads 1");
  run_well("bake " + map + " --rays 64 -o two.exr --threads 2");
  EXPECT_TRUE(read_bytes(folder_ / "one.exr") == read_bytes(folder_ / "two.exr"));
}

TEST_F(OpenHoles, ChangeNothingWhereThereAreNone) {
  write_map("map.exr", SyntheticKind::kBricks, 32, 32);
  run_well("bake map.exr -o refuse.exr");
  run_well("bake map.exr -o open.exr --holes open");
  EXPECT_EQ(read_bake(folder_ / "refuse.exr").bake.visibility.values,
            read_bake(folder_ / "open.exr").bake.visibility.values);
}

TEST_F(OpenHoles, AreRefusedWhereTheyCannotBe) {
  const std::string map = write_bumps();
  expect_refusal("bake " + map + " -o b.exr --tracer slice", HasSubstr("--holes"));
  expect_refusal("bake " + map + " -o b.exr --tracer march --patches texels", HasSubstr("--holes"));
  const std::string none = write_raw(4, 4, [](int, int) { return kNone; });
  expect_refusal("bake " + none + " -o b.exr", HasSubstr("no height in any texel"));
}

}  // namespace
}  // namespace hemibake
