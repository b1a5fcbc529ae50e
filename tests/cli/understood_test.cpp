// What was understood of a map, told back; contradictions between map, normal map and options; units.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "bake/record.h"
#include "cli/run_hemibake.h"
#include "core/color.h"
#include "io/bake_file.h"
#include "io/foreign_images.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr int kSide = 32;
constexpr double kPi2 = 2 * std::numbers::pi;

// A smooth tiled relief of 0..1 that leans unlike in x and y.
double relief(int x, int y) {
  const double u = kPi2 * x / kSide, v = kPi2 * y / kSide;
  return 0.5 + 0.25 * std::sin(u) * std::cos(2 * v) + 0.2 * std::sin(2 * u + 3 * v);
}

// The normal of the relief, `amplitude_m` high on a map of 1 m, by central differences. y down the rows.
glm::dvec3 relief_normal(int x, int y, double amplitude_m) {
  const double scale = amplitude_m * kSide / 2;
  return glm::normalize(glm::dvec3(-scale * (relief(x + 1, y) - relief(x - 1, y)),
                                   -scale * (relief(x, y + 1) - relief(x, y - 1)), 1));
}

class Understood : public CliTest {
 protected:
  using Texel = std::function<std::vector<double>(int x, int y)>;

  // Writes an image whose texels are as stored.
  template <class T>
  void write(const std::string& name, const std::vector<std::string>& channels, const Texel& texel) const {
    std::vector<T> values;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        for (const double value : texel(x, y))
          values.push_back(std::is_integral_v<T> ? static_cast<T>(std::lround(value))
                                                 : static_cast<T>(value));
    OIIO::ImageSpec spec = spec_of(kSide, kSide, channels);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    write_foreign(folder_ / name, spec, values);
  }
  void write_unit_map() const {
    write<float>("unit.exr", {"Y"}, [](int x, int y) { return std::vector<double>{relief(x, y)}; });
  }
  // Writes an 8-bit normal map of 0..1 numbers.
  void write_normals(const std::string& name, const std::function<glm::dvec3(glm::dvec3)>& stored) const {
    write<uint8_t>(name, {"R", "G", "B"}, [&](int x, int y) {
      const glm::dvec3 c = stored(0.5 + 0.5 * relief_normal(x, y, 0.1));
      return std::vector<double>{255 * c.x, 255 * c.y, 255 * c.z};
    });
  }
  Grid<float> ao(const std::string& arguments) const {
    run_well(fmt::format("bake {} -o ao.exr --rays 16 --outputs ao", arguments));
    return read_bake(folder_ / "ao.exr").bake.visible_fraction;
  }
  void expect_near_ao(const std::string& arguments, const Grid<float>& expected, double tolerance) const {
    const Grid<float> actual = ao(arguments);
    ASSERT_EQ(actual.size(), expected.size());
    for (size_t i = 0; i < actual.size(); ++i) ASSERT_NEAR(actual[i], expected[i], tolerance) << arguments;
  }
  std::string warnings(const std::string& arguments) const {
    return run_well(fmt::format("bake {} -o w.exr --rays 4 --outputs ao", arguments)).standard_error;
  }
  nlohmann::json map_of(const std::string& arguments) const {
    return run_json(fmt::format("bake {} -o j.exr --rays 4 --outputs ao", arguments)).at("map");
  }
};

TEST_F(Understood, IsSaidInTextAndJson) {
  write<uint16_t>("map.png", {"R", "G", "B"}, [](int x, int y) {
    const double value = 65535 * (0.25 + 0.5 * relief(x, y));
    return std::vector<double>{value, value, value};
  });
  EXPECT_THAT(run_well("bake map.png -o b.exr --rays 4 --outputs ao").standard_output,
              AllOf(HasSubstr("map       PNG, 16-bit integers, G of R, G, B: 0."),
                    HasSubstr(" m over texels of 0.03125 m, wrap, normals of the heights")));
  const nlohmann::json map = map_of("map.png --amplitude 2");
  EXPECT_EQ(map.at("format"), "PNG");
  EXPECT_EQ(map.at("channel"), "G");
  EXPECT_EQ(map.at("heights"), "unit");
  EXPECT_EQ(map.at("texel_x_m"), 1.0 / kSide);
  EXPECT_NEAR(map.at("highest_m").get<double>(), 2 * map.at("high_value").get<double>(), 1e-12);
  EXPECT_THAT(run_well("textures map.png -o t --maps ao --rays 4").standard_output, StartsWith("map       "));
  EXPECT_TRUE(run_json("textures map.png -o t --maps ao --rays 4").contains("map"));
  EXPECT_TRUE(run_json("bake map.png --dry-run").contains("map"));
}

TEST_F(Understood, MetresAreMetresWhateverTheirBitDepth) {
  write_unit_map();
  const auto metres = [](int x, int y) { return std::vector<double>{std::round(4000 * relief(x, y) - 500)}; };
  write<float>("float.exr", {"Y"}, metres);
  write<int16_t>("int.tif", {"Y"}, metres);
  write<uint16_t>("uint.png", {"Y"}, [](int x, int y) {
    return std::vector<double>{std::round(4000 * relief(x, y) - 500) + 500};
  });
  const Grid<float> expected = ao("unit.exr --amplitude 4000 --size 9600");
  for (const char* map : {"float.exr", "float.exr --amplitude 1", "int.tif", "int.tif --amplitude 1",
                          "uint.png --heights metres", "float.exr --heights metres"})
    expect_near_ao(fmt::format("{} --size 9600", map), expected, 2e-3);
  expect_near_ao("int.tif --texel 300", expected, 2e-3);
  EXPECT_EQ(map_of("int.tif --size 9600").at("heights"), "metres");
  EXPECT_EQ(map_of("float.exr --size 9600").at("heights_because"), "floats that range over more than 2");
}

TEST_F(Understood, SignedIntegersAreMetresAlsoWhereAllLieAboveZero) {
  const auto metres = [](int x, int y) { return std::vector<double>{std::round(800 + 600 * relief(x, y))}; };
  write<int16_t>("int.tif", {"Y"}, metres);
  write<float>("float.exr", {"Y"}, metres);
  const Grid<float> expected = ao("float.exr --size 320");
  EXPECT_LT(*std::ranges::min_element(expected.values), 0.5);
  expect_near_ao("int.tif --size 320", expected, 0);
  expect_near_ao("int.tif --size 320 --amplitude 1", expected, 0);
}

TEST_F(Understood, HolesAreRefusedOrFilled) {
  const auto hole = [](int x, int y) { return std::hypot(x - 9, y - 12) < 4; };
  write<float>("holes.exr", {"Y"},
               [&](int x, int y) { return std::vector<double>{hole(x, y) ? -9999 : 100 * relief(x, y)}; });
  write<float>("nan.exr", {"Y"}, [&](int x, int y) {
    return std::vector<double>{hole(x, y) ? std::numeric_limits<double>::quiet_NaN() : 100 * relief(x, y)};
  });
  EXPECT_THAT(warnings("holes.exr --size 32"), HasSubstr("--nodata -9999"));
  expect_refusal("bake holes.exr -o b.exr --nodata -9999", HasSubstr("--holes fill"));
  expect_refusal("bake nan.exr -o b.exr", HasSubstr("45 texels have no height (first 7,9)"));
  const Grid<float> filled = ao("holes.exr --size 32 --nodata -9999 --holes fill");
  expect_near_ao("nan.exr --size 32 --holes fill", filled, 0);
  EXPECT_EQ(map_of("nan.exr --size 32 --holes fill").at("holes"), 45);
}

TEST_F(Understood, TexelsThatAreNotSquareAreMadeSo) {
  const auto metres = [](double x, double y) {
    return 400 * std::sin(kPi2 * x / 320) * std::cos(kPi2 * y / 960);
  };
  write<float>("oblong.exr", {"Y"},
               [&](int x, int y) { return std::vector<double>{metres(10 * x, 30 * y)}; });
  // The same ground in square texels: linear between the rows, which the middle of each three has exactly.
  Grid<float> square(kSide, 3 * kSide);
  for (int j = 0; j < square.height; ++j)
    for (int x = 0; x < kSide; ++x) {
      const double y = (j - 1) / 3.0, below = std::floor(y);
      const double a = metres(10 * x, 30 * below), b = metres(10 * x, 30 * (below + 1));
      square(x, j) = static_cast<float>(a + (y - below) * (b - a));
    }
  write_height_map(folder_ / "square.exr", square, make_provenance("test"));
  const Grid<float> expected = ao("square.exr --texel 10");
  const Grid<float> made = ao("oblong.exr --texel 10,30");
  ASSERT_EQ(made.height, square.height);
  double sum = 0, squares = 0;
  for (size_t i = 0; i < made.size(); ++i) {
    const double error = static_cast<double>(made[i]) - static_cast<double>(expected[i]);
    sum += error, squares += error * error;
  }
  const auto count = static_cast<double>(made.size());
  EXPECT_LT(std::abs(sum / count), 1e-5);
  EXPECT_LT(std::sqrt(squares / count), 1e-4);
  EXPECT_THAT(run_well("bake oblong.exr -o b.exr --texel 10,30 --rays 4 --outputs ao").standard_output,
              HasSubstr("texels of 10 x 30 m, wrap, made square: 32 x 96"));
}

TEST_F(Understood, AnAmplitudeOfFloatsScalesThemAndMetresTakeNone) {
  write_unit_map();
  write<float>("wide.exr", {"Y"}, [](int x, int y) { return std::vector<double>{10 * relief(x, y)}; });
  write<int16_t>("int.tif", {"Y"},
                 [](int x, int y) { return std::vector<double>{500 * relief(x, y) - 200}; });
  expect_near_ao("wide.exr --amplitude 0.02", ao("unit.exr --amplitude 0.2"), 1e-5);
  EXPECT_THAT(run_well("bake wide.exr -o b.exr --rays 4 --amplitude 0.02").standard_output,
              HasSubstr("not metres: amplitude given"));
  expect_refusal("bake int.tif -o x.exr --amplitude 0.5",
                 AllOf(StartsWith("int.tif: "), HasSubstr("--amplitude 0.5"), HasSubstr("--heights unit")));
  expect_refusal("bake unit.exr -o x.exr --heights metres --amplitude 3", HasSubstr("--amplitude 3"));
}

TEST_F(Understood, LowAndHighAreTheHeightsOfBlackAndWhite) {
  write_unit_map();
  write<float>("inverse.exr", {"Y"}, [](int x, int y) { return std::vector<double>{1 - relief(x, y)}; });
  const Grid<float> expected = ao("unit.exr --amplitude 0.3");
  EXPECT_EQ(ao("unit.exr --low 2 --high 2.3").values.size(), expected.size());
  expect_near_ao("unit.exr --low 2 --high 2.3", expected, 1e-5);
  expect_near_ao("unit.exr --high 0.3", expected, 0);
  expect_near_ao("inverse.exr --low 0.3 --high 0", expected, 1e-4);
  EXPECT_NEAR(map_of("unit.exr --low -5 --high 5").at("lowest_m").get<double>(),
              -5 + 10 * map_of("unit.exr").at("low_value").get<double>(), 1e-6);
  expect_refusal("bake unit.exr -o x.exr --low 2", AllOf(HasSubstr("--low"), HasSubstr("--high")));
  expect_refusal("bake unit.exr -o x.exr --high 2 --amplitude 1",
                 HasSubstr("--high: is given with --amplitude"));
  expect_refusal("bake unit.exr -o x.exr --size 2 --texel 1", HasSubstr("--texel: is given with --size"));
}

TEST_F(Understood, TexelSizeIsTheSizeOverTheTexels) {
  write_unit_map();
  expect_near_ao("unit.exr --texel 0.0625", ao("unit.exr --size 2"), 0);
}

TEST_F(Understood, WhatStandsOutIsNamed) {
  const auto with = [](double sentinel, int count) {
    return [=](int x, int y) {
      return std::vector<double>{y == 3 && x < count ? sentinel : 300 + 100 * relief(x, y)};
    };
  };
  write<float>("one.exr", {"Y"}, with(-9999, 1));
  write<int16_t>("many.tif", {"Y"}, with(-32768, 20));
  write<float>("huge.exr", {"Y"}, with(1e20, 1));
  write<float>("none.exr", {"Y"}, with(301, 1));
  EXPECT_THAT(warnings("one.exr --size 1000"), HasSubstr("1 texel is -9999"));
  EXPECT_THAT(warnings("one.exr --size 1000"), HasSubstr("--nodata -9999"));
  EXPECT_THAT(warnings("many.tif --size 1000"), AllOf(HasSubstr("20 texels"), HasSubstr("--nodata -32768")));
  EXPECT_THAT(warnings("none.exr --size 1000"), "");
  expect_refusal("bake huge.exr -o x.exr", HasSubstr("--nodata 1e+20"));
}

TEST_F(Understood, WhatCanHardlyBeMeantIsNamed) {
  write<float>("flat.exr", {"Y"}, [](int, int) { return std::vector<double>{0.5}; });
  write<float>("metres.exr", {"Y"}, [](int x, int y) { return std::vector<double>{400 * relief(x, y)}; });
  write_unit_map();
  EXPECT_THAT(warnings("flat.exr"), HasSubstr("heights are all alike (0.5), AO will be 1"));
  EXPECT_THAT(warnings("metres.exr"), AllOf(HasSubstr("steeper than 8"), HasSubstr("--size")));
  EXPECT_THAT(warnings("unit.exr --size 100000"),
              AllOf(HasSubstr("range over"), HasSubstr("--heights metres")));
  EXPECT_EQ(warnings("unit.exr"), "");
  const nlohmann::json json = run_json("bake flat.exr -o f.exr --rays 4");
  EXPECT_THAT(json.at("warnings").at(0).get<std::string>(), HasSubstr("all alike"));
}

TEST_F(Understood, NormalsOfABakeAreReadBackToTheSameBytes) {
  write_map("map.exr", SyntheticKind::kShapes, kSide, kSide);
  const Grid<float> expected = ao("map.exr --amplitude 0.4");
  run_well("bake map.exr -o normals.exr --rays 4 --outputs normal,ao --amplitude 0.4");
  EXPECT_EQ(ao("map.exr --amplitude 0.4 --normals normals.exr").values, expected.values);
  EXPECT_EQ(ao("map.exr --amplitude 0.4 --normals normals.exr --normal-y down").values, expected.values);
  expect_refusal("bake map.exr -o x.exr --normals normals.exr --normal-y up",
                 AllOf(StartsWith("normals.exr: "), HasSubstr("--normal-y down")));
}

TEST_F(Understood, SignedFloatsAreTakenAsTheyAre) {
  write_unit_map();
  const Grid<float> expected = ao("unit.exr");
  write<float>("signed.exr", {"R", "G", "B"}, [](int x, int y) {
    const glm::dvec3 n = relief_normal(x, y, 0.1);
    return std::vector<double>{n.x, -n.y, n.z};
  });
  expect_near_ao("unit.exr --normals signed.exr --normal-y up", expected, 1e-5);
  EXPECT_EQ(map_of("unit.exr --normals signed.exr --normal-y up").at("normals").at("encoding"), "signed");
}

TEST_F(Understood, NormalsAgainstTheHeightsAreSaidAndAutoDecides) {
  write_unit_map();
  write_normals("down.png", [](glm::dvec3 c) { return c; });
  write_normals("up.png", [](glm::dvec3 c) { return glm::dvec3(c.x, 1 - c.y, c.z); });
  write_normals("left.png", [](glm::dvec3 c) { return glm::dvec3(1 - c.x, c.y, c.z); });
  const Grid<float> expected = ao("unit.exr --normals down.png --normal-y down");
  for (const char* name : {"directx", "dx", "auto"})
    EXPECT_EQ(ao(fmt::format("unit.exr --normals down.png --normal-y {}", name)).values, expected.values);
  for (const char* name : {"up", "opengl", "gl", "auto"})
    expect_near_ao(fmt::format("unit.exr --normals up.png --normal-y {}", name), expected, 5e-3);
  EXPECT_EQ(warnings("unit.exr --normals down.png --normal-y down"), "");
  EXPECT_THAT(warnings("unit.exr --normals down.png --normal-y up"), HasSubstr("expected --normal-y down"));
  EXPECT_THAT(warnings("unit.exr --normals up.png --normal-y down"), HasSubstr("expected --normal-y up"));
  EXPECT_THAT(warnings("unit.exr --normals left.png --normal-y down"),
              HasSubstr("expected --normal-channels -R,G,B"));
  expect_near_ao("unit.exr --normals left.png --normal-y down --normal-channels -R,G,B", expected, 5e-3);
  EXPECT_EQ(run_json("bake unit.exr -o j.exr --rays 4 --normals up.png --normal-y auto").at("normal_y"),
            "up");
  expect_refusal("bake unit.exr -o x.exr --normals up.png", HasSubstr("(up fits the heights)"));
  expect_refusal("textures unit.exr -o t --normals up.png", HasSubstr("--normals-y up or --normals-y down"));
  EXPECT_THAT(
      run_well("textures unit.exr -o t --maps ao --rays 4 --normals up.png --normals-y down").standard_error,
      HasSubstr("expected --normals-y up"));
}

TEST_F(Understood, NormalsCodedOtherwiseAreNamedAndRead) {
  write_unit_map();
  write_normals("linear.png", [](glm::dvec3 c) { return c; });
  write_normals("srgb.png", [](glm::dvec3 c) {
    return glm::dvec3(srgb_from_linear(c.x), srgb_from_linear(c.y), srgb_from_linear(c.z));
  });
  write<uint8_t>("dxt5nm.png", {"R", "G", "B", "A"}, [](int x, int y) {
    const glm::dvec3 c = 0.5 + 0.5 * relief_normal(x, y, 0.1);
    return std::vector<double>{255, 255 * c.y, 255 * c.y, 255 * c.x};
  });
  const Grid<float> expected = ao("unit.exr --normals linear.png --normal-y dx");
  EXPECT_THAT(warnings("unit.exr --normals srgb.png --normal-y dx"), HasSubstr("--normal-encoding srgb"));
  expect_near_ao("unit.exr --normals srgb.png --normal-y dx --normal-encoding srgb", expected, 2e-2);
  const CommandResult swizzled = run("bake unit.exr -o x.exr --rays 4 --normals dxt5nm.png --normal-y dx");
  EXPECT_THAT(swizzled.standard_error, HasSubstr("--normal-channels A,G"));
  expect_near_ao("unit.exr --normals dxt5nm.png --normal-y dx --normal-channels A,G", expected, 1e-2);
  expect_refusal("bake unit.exr -o x.exr --normals linear.png --normal-y dx --normal-channels R",
                 HasSubstr("--normal-channels: 'R'"));
}

TEST_F(Understood, NormalsOfAnotherMapOrSteepnessAreNamed) {
  write_unit_map();
  write_normals("normals.png", [](glm::dvec3 c) { return c; });
  write_map("other.exr", SyntheticKind::kNoise, kSide, kSide);
  EXPECT_THAT(warnings("other.exr --normals normals.png --normal-y dx"),
              HasSubstr("hardly follows the heights"));
  EXPECT_THAT(warnings("unit.exr --amplitude 0.01 --normals normals.png --normal-y dx"),
              AllOf(HasSubstr("its slopes are 10"), HasSubstr("--amplitude 0.1")));
}

// A bake reads its map back as it was, with whatever units were understood.
TEST_F(Understood, IsReadBackTheSame) {
  write_unit_map();
  write<int16_t>("int.tif", {"Y"},
                 [](int x, int y) { return std::vector<double>{500 * relief(x, y) - 200}; });
  write<float>("wide.exr", {"Y"}, [](int x, int y) { return std::vector<double>{10 * relief(x, y)}; });
  write_normals("up.png", [](glm::dvec3 c) { return glm::dvec3(c.x, 1 - c.y, c.z); });
  for (const char* arguments :
       {"unit.exr", "unit.exr --low 3 --high 1", "unit.exr --texel 0.3", "int.tif --size 700", "wide.exr",
        "wide.exr --amplitude 0.3", "unit.exr --normals up.png --normal-y auto"}) {
    run_well(fmt::format("bake {} -o b.exr --rays 4 --outputs ao,normal", arguments));
    const BakeFile file = read_bake(folder_ / "b.exr");
    const LoadedMap map = load_map(recorded_map_settings(file.provenance, folder_ / "b.exr"));
    EXPECT_EQ(map.surface.normals.values, file.bake.normals.values) << arguments;
    EXPECT_EQ(map.surface.texel_size_m, file.provenance.at("texel_size_m").get<double>()) << arguments;
    Provenance again;
    record_map(map.settings, map.sha256, again);
    EXPECT_EQ(again.at("amplitude_m"), file.provenance.at("amplitude_m")) << arguments;
    EXPECT_EQ(again.at("heights"), file.provenance.at("heights")) << arguments;
  }
}

// 0.2.0 took every value for 0..1 and every normal map for 0..1, and recorded neither.
TEST_F(Understood, BakesOfOldVersionsAreReadAsTheyWere) {
  write<float>("wide.exr", {"Y"}, [](int x, int y) { return std::vector<double>{10 * relief(x, y)}; });
  run_well("bake wide.exr -o b.exr --rays 4 --outputs ao,normal --amplitude 0.05 --heights unit");
  const BakeFile file = read_bake(folder_ / "b.exr");
  Provenance old = file.provenance;
  old.erase("heights");
  const LoadedMap map = load_map(recorded_map_settings(old, folder_ / "b.exr"));
  EXPECT_EQ(map.surface.normals.values, file.bake.normals.values);
  old["amplitude_m"] = 1.0;  // would be metres now
  EXPECT_EQ(recorded_map_settings(old, folder_ / "b.exr").heights, HeightUnit::kUnit);
  old.erase("amplitude_m");
  EXPECT_THROW(recorded_map_settings(old, folder_ / "b.exr"), InputError);
}

TEST_F(Understood, ManyMapsAreSkippedByWhatWasUnderstood) {
  std::filesystem::create_directory(folder_ / "maps");
  write<int16_t>("maps/a.tif", {"Y"},
                 [](int x, int y) { return std::vector<double>{500 * relief(x, y) - 200}; });
  write<float>("maps/b.exr", {"Y"}, [](int x, int y) { return std::vector<double>{relief(x, y)}; });
  run_well("bake maps -o out --rays 4 --outputs ao");
  EXPECT_THAT(run_well("bake maps -o out --rays 4 --outputs ao").standard_output,
              AllOf(HasSubstr("a.tif: done before"), HasSubstr("b.exr: done before")));
  // The same units by name.
  EXPECT_THAT(run_well("bake maps -o out --rays 4 --outputs ao --size 1").standard_output,
              AllOf(HasSubstr("a.tif: done before"), HasSubstr("b.exr: done before")));
  EXPECT_THAT(run_well("bake maps -o out --rays 4 --outputs ao --size 2").standard_output,
              Not(HasSubstr("done before")));
}

}  // namespace
}  // namespace hemibake
