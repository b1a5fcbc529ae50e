// Sky-view factor, openness and horizons through the real binary: closed forms in every format.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "cli/run_hemibake.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

constexpr int kSide = 33, kMiddle = 16;

class TerrainMaps : public CliTest {
 protected:
  // Writes heights in texels: texels are of 1 m, values are metres.
  template <class Height>
  void write(const Height& height) const {
    Grid<float> heights(kSide, kSide);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) heights(x, y) = static_cast<float>(height(x, y));
    write_map("map.exr", heights);
  }
  void make(const std::string& maps, const std::string& format) const {
    run_well(
        fmt::format("textures map.exr -o out --size {} --heights metres --edge ground --maps {} --format {}",
                    kSide, maps, format));
  }
  double middle(const std::string& file, const std::string& channel = "") const {
    return static_cast<double>(read_height_map(folder_ / ("out/map_" + file), channel)(kMiddle, kMiddle));
  }
};

struct Format {
  const char *name, *ending;
  bool is_float;
};
constexpr Format kFormats[] = {{"png16", "png", false}, {"exr", "exr", true}, {"tif", "tif", true}};
constexpr const char* kPlanes = "svf,openness,negative-openness";

TEST_F(TerrainMaps, PlaneOf45DegreesIsOpenDownhillToTheHorizontal) {
  write([](int x, int) { return x; });
  // Uphill γ = atan(sin a): the mean over azimuths of 1 − sin γ is 1 − atan(1)/π = ¾.
  for (const Format& format : kFormats) {
    make(kPlanes, format.name);
    EXPECT_NEAR(middle(fmt::format("svf.{}", format.ending)), 0.75, 1e-4) << format.name;
    const double scale = format.is_float ? 1 : 180;
    double uphill = 0;  // mean of γ, degrees
    for (int k = 0; k < 1000; ++k) uphill += std::atan(std::sin(M_PI * (k + 0.5) / 1000)) * 180 / M_PI / 2000;
    EXPECT_NEAR(scale * middle(fmt::format("openness.{}", format.ending)), 90 - uphill, 0.01);
    EXPECT_NEAR(scale * middle(fmt::format("negative_openness.{}", format.ending)), 90 - uphill, 0.01);
  }
}

TEST_F(TerrainMaps, FlatGroundSeesTheWholeSky) {
  write([](int, int) { return 3; });
  for (const Format& format : kFormats) {
    make(kPlanes, format.name);
    EXPECT_EQ(middle(fmt::format("svf.{}", format.ending)), 1) << format.name;
    const double right_angle = format.is_float ? 90 : 0.5;
    EXPECT_NEAR(middle(fmt::format("openness.{}", format.ending)), right_angle, 1e-5);
    EXPECT_NEAR(middle(fmt::format("negative_openness.{}", format.ending)), right_angle, 1e-5);
  }
}

TEST_F(TerrainMaps, PitHasTheSkyOfItsRim) {
  // Depth 8, radius 10: 1 − sin atan(8/10), up to the staircase of the rim; its triangles end a texel inside.
  write([](int x, int y) { return std::hypot(x - kMiddle, y - kMiddle) < 10 ? 0 : 8; });
  for (const Format& format : kFormats) {
    make("svf,openness", format.name);
    const double angle = std::atan2(8.0, 10.0);
    EXPECT_NEAR(middle(fmt::format("svf.{}", format.ending)), 1 - std::sin(angle), 0.02) << format.name;
    EXPECT_NEAR((format.is_float ? 1 : 180) * middle(fmt::format("openness.{}", format.ending)),
                90 - angle * 180 / M_PI, 1.5);
  }
}

TEST_F(TerrainMaps, HorizonOfAWallIsItsElevation) {
  write([](int x, int) { return x >= kMiddle + 8 ? 6 : 0; });
  // TIFF numbers its channels.
  for (const auto& [format, east, north_east, west] :
       {std::array{"exr", "horizon.090", "horizon.045", "horizon.270"}, std::array{"tif", "2", "1", "6"}}) {
    make("horizon:8", format);
    const std::string file = fmt::format("horizon.{}", format);
    EXPECT_NEAR(middle(file, east), std::atan(6.0 / 8) * 180 / M_PI, 1e-4) << format;
    EXPECT_NEAR(middle(file, north_east), std::atan(6.0 / std::sqrt(128.0)) * 180 / M_PI, 1e-4);
    EXPECT_NEAR(middle(file, west), 0, 1e-4);
  }
  expect_refusal("textures map.exr -o out --maps horizon:8 --edge ground --format png16",
                 testing::HasSubstr("expected --format exr or tif"));
}

}  // namespace
}  // namespace hemibake
