// `hemibake textures` through the real binary: the files hold the planes of the bake to half a step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/run_hemibake.h"
#include "io/bake_file.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

constexpr double kStep8 = 1.0 / 255, kStep16 = 1.0 / 65535, kFloatRounding = 6e-8;

// The largest difference of two planes.
double largest_difference(const Grid<float>& a, const Grid<float>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  return worst;
}

class Textures : public CliTest {
 protected:
  void SetUp() override {
    write_map("map.exr", SyntheticKind::kBricks, 24, 20);
    run_well("bake map.exr -o b.exr --rays 8 --bounces 6");
    bake_ = read_bake(folder_ / "b.exr").bake;
  }

  Grid<float> read(const std::string& name, const std::string& channel = "") const {
    return read_height_map(folder_ / name, channel);
  }

  Bake bake_;
};

TEST_F(Textures, HoldTheirPlanesToHalfAStep) {
  const struct {
    const char* format;
    const char* ending;
    double tolerance;
  } formats[] = {
      {"png16", "png", 0.5 * kStep16}, {"png8", "png", 0.5 * kStep8}, {"exr", "exr", 0}, {"tif", "tif", 0}};
  for (const auto& each : formats) {
    // Names of their own: Clang 14 does not capture structured bindings.
    const char *format = each.format, *ending = each.ending;
    const double tolerance = each.tolerance;
    for (const char* maps :
         {"visibility,ao", "bounce"})  // bytes of both together are chosen (bounce_map_test.cpp)
      run_well(fmt::format("textures b.exr -o {0} --maps {1} --format {0}", format, maps));
    const auto off = [&](const char* name, const Grid<float>& plane) {
      return largest_difference(read(fmt::format("{}/b_{}.{}", format, name, ending)), plane);
    };
    EXPECT_LE(off("visibility", bake_.visibility), tolerance + kFloatRounding) << format;
    EXPECT_LE(off("ao", bake_.visible_fraction), tolerance + kFloatRounding) << format;
    EXPECT_LE(off("bounce", bake_.bounce), tolerance + kFloatRounding) << format;
  }
}

TEST_F(Textures, VisibilityIsTheDirectLightOverPiAndABounceIsAboveIt) {
  for (size_t i = 0; i < bake_.visibility.size(); ++i) {
    EXPECT_NEAR(bake_.visibility[i], bake_.irradiance[0][i] / 3.14159265f, 1e-6f);
    EXPECT_GE(bake_.bounce[i], bake_.visibility[i] - 1e-6f);
    EXPECT_LE(bake_.bounce[i], 1 + 1e-6f);
  }
  EXPECT_EQ(bake_.bounce_albedo, 0.9);
}

TEST_F(Textures, GreenOfVectorsTurnsAround) {
  run_well("textures b.exr -o up --maps bent,normal --format exr");
  run_well("textures b.exr -o down --maps bent,normal --format exr --normal-y down");
  for (const std::string name : {"b_bent.exr", "b_normal.exr"}) {
    const Grid<float> up = read("up/" + name, "G"), down = read("down/" + name, "G");
    for (size_t i = 0; i < up.size(); ++i) EXPECT_NEAR(up[i] + down[i], 1, 1e-6);
    EXPECT_EQ(read("up/" + name, "R").values, read("down/" + name, "R").values);
  }
  const Grid<float> green = read("down/b_normal.exr", "G");
  for (size_t i = 0; i < green.size(); ++i) EXPECT_NEAR(green[i], 0.5 + 0.5 * bake_.normals[i].y, 1e-6);
}

TEST_F(Textures, BentNormalsMayCarryVisibility) {
  run_well("textures b.exr -o l --maps bent --format exr --bent-length visibility");
  const Grid<float> r = read("l/b_bent.exr", "R"), g = read("l/b_bent.exr", "G"),
                    b = read("l/b_bent.exr", "B");
  for (size_t i = 0; i < r.size(); ++i) {
    const glm::vec3 bent{2 * r[i] - 1, 1 - 2 * g[i], 2 * b[i] - 1}, normal = bake_.normals[i];
    const float cosine = bent.x * normal.x + bent.y * normal.y + bent.z * normal.z;
    EXPECT_LE(cosine, bake_.visibility[i] + 1e-5f);
    if (cosine < bake_.visibility[i] - 1e-5f) {
      EXPECT_GT(bent.x * bent.x + bent.y * bent.y + bent.z * bent.z, 1 - 1e-5f) << "cut though it had room";
    }
  }
}

TEST_F(Textures, PackedChannelsAreWhereEnginesWantThem) {
  run_well("textures b.exr -o p --pack orm --roughness 0.25 --metallic 0.75 --format exr");
  EXPECT_LE(largest_difference(read("p/b_orm.exr", "R"), bake_.visibility), kFloatRounding);
  EXPECT_FLOAT_EQ(read("p/b_orm.exr", "G")[3], 0.25f);
  EXPECT_FLOAT_EQ(read("p/b_orm.exr", "B")[3], 0.75f);
  run_well("textures b.exr -o m --engine unity --occlusion ao --roughness 0.25 --format exr");
  EXPECT_FLOAT_EQ(read("m/b_MaskMap.exr", "R")[3], 0);
  EXPECT_LE(largest_difference(read("m/b_MaskMap.exr", "G"), bake_.visible_fraction), kFloatRounding);
  EXPECT_FLOAT_EQ(read("m/b_MaskMap.exr", "A")[3], 0.75f);
}

TEST_F(Textures, IrradianceIsTheSeriesAtItsAlbedo) {
  run_well("textures b.exr -o i --maps irradiance --albedo 0,0.5,1 --format exr");
  EXPECT_LE(largest_difference(read("i/b_irradiance.exr", "R"), bake_.visibility), 1e-6);
  const Grid<float> half = read("i/b_irradiance.exr", "G"), whole = read("i/b_irradiance.exr", "B");
  for (size_t i = 0; i < half.size(); ++i) {
    double sum = 0;
    for (size_t b = bake_.irradiance.size(); b-- > 0;)
      sum = sum / 2 + static_cast<double>(bake_.irradiance[b][i]) / 3.14159265358979;
    EXPECT_GE(half[i], sum - 1e-6);
    EXPECT_LE(half[i], sum + 0.02) << "the tail after six bounces at albedo 0.5";
    EXPECT_LE(whole[i], 1);
  }
}

// A dither adds noise of one step at most, and none on average.
TEST_F(Textures, DitherIsUnbiased) {
  write_map("slope.exr", SyntheticKind::kNoise, 96, 96);
  run_well("bake slope.exr -o s.exr --rays 8 --outputs ao");
  run_well("textures s.exr -o d --maps visibility --format png8 --dither");
  run_well("textures s.exr -o again --maps visibility --format png8 --dither");
  const Grid<float> truth = read_bake(folder_ / "s.exr").bake.visibility;
  const Grid<float> dithered = read("d/s_visibility.png");
  double sum = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LE(std::abs(dithered[i] - truth[i]), kStep8 + kFloatRounding);
    sum += static_cast<double>(dithered[i]) - static_cast<double>(truth[i]);
  }
  const double standard_error = kStep8 * 0.5 / 96;
  EXPECT_LE(std::abs(sum / static_cast<double>(truth.size())), 4 * standard_error);
  EXPECT_EQ(dithered.values, read("again/s_visibility.png").values);
}

TEST_F(Textures, AMapIsBakedFirstAndOnlyAsFarAsNeeded) {
  run_well("textures map.exr -o t --maps visibility,bounce --rays 8 --format exr");
  EXPECT_LE(largest_difference(read("t/map_visibility.exr"), bake_.visibility), kFloatRounding);
  // However many bounces are stored, the light at the bounce map's albedo is converged.
  EXPECT_LE(largest_difference(read("t/map_bounce.exr"), bake_.bounce), 2e-4);
}

TEST_F(Textures, BakesOfOlderVersionsServe) {
  BakeFile old = read_bake(folder_ / "b.exr");
  old.bake.visibility = {};
  old.bake.bounce = {};
  old.provenance.erase("bounce_albedo");
  write_bake(folder_ / "old.exr", old.bake, old.provenance);
  run_well("textures old.exr -o o --maps visibility,bounce --format exr");
  EXPECT_LE(largest_difference(read("o/old_visibility.exr"), bake_.visibility), 1e-6);
  EXPECT_LE(largest_difference(read("o/old_bounce.exr"), bake_.bounce), 0.05) << "six bounces and their tail";
}

TEST_F(Textures, ExtremesAreTextures) {
  write_map("one.exr", SyntheticKind::kFlat, 1, 1);
  run_well("textures one.exr -o one --rays 4 --maps visibility,ao,bent,normal,bounce,irradiance");
  EXPECT_EQ(read("one/one_visibility.png")[0], 1);
  for (const char* amplitude : {"0", "1e-6", "1000"}) {
    const std::string folder = fmt::format("a{}", amplitude);
    run_well(
        fmt::format("textures map.exr -o {} --rays 4 --amplitude {} --maps visibility,bent,bounce "
                    "--format exr",
                    folder, amplitude));
    for (const float value : read(folder + "/map_bounce.exr").values) EXPECT_TRUE(value >= 0 && value <= 1);
  }
}

// They have no header that says whether they are bakes.
TEST_F(Textures, OfMapsThatAreNoImages) {
  std::string raw(64, '\0');
  for (size_t i = 0; i < raw.size(); ++i) raw[i] = static_cast<char>(i * 37 % 251);
  write_bytes(folder_ / "heights.raw", raw);
  write_bytes(folder_ / "heights.pgm", "P5 8 8 255\n" + raw);
  run_well("textures heights.raw --raw 8x8:u8 -o raw --maps ao --rays 8");
  run_well("textures heights.pgm -o pgm --maps ao --rays 8");
  EXPECT_EQ(read("raw/heights_ao.png").values, read("pgm/heights_ao.png").values);
}

TEST_F(Textures, RefusesWhatMakesNoSense) {
  using testing::HasSubstr;
  run_well("bake map.exr -o ao.exr --rays 4 --outputs ao");
  expect_refusal("textures ao.exr -o t --maps bounce", HasSubstr("ao.exr"));
  expect_refusal("textures ao.exr -o t --maps bent", HasSubstr("ao.exr"));
  expect_refusal("textures b.exr -o t --maps irradiance --albedo 1.5", HasSubstr("albedo"));
  expect_refusal("textures b.exr -o t --maps cubes", HasSubstr("cubes"));
  expect_refusal("textures b.exr -o t --dither --format png16", HasSubstr("dither"));
  expect_refusal("textures b.exr -o t --rays 8", HasSubstr("rays"));
  expect_refusal("textures none.png -o t", HasSubstr("none.png"));
  // Its plane `bounce` is converged, but there are no bounces to sum at another albedo.
  run_well("bake map.exr -o zero.exr --links l.h5 --bounces 0 --rays 4");
  run_well("textures zero.exr -o z --maps bounce");
  expect_refusal("textures zero.exr -o t --maps bounce,irradiance", HasSubstr("has no bounces"));
  Bake mixed = bake_;
  std::fill(mixed.visible_fraction.values.begin(), mixed.visible_fraction.values.end(), 0.05f);
  write_bake(folder_ / "mixed.exr", mixed, read_bake(folder_ / "b.exr").provenance);
  expect_refusal("textures mixed.exr -o t --maps visibility,ao", HasSubstr("mixed.exr"));
}

}  // namespace
}  // namespace hemibake
