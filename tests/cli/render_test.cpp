// `hemibake render` through the real binary: pictures, numbers about light, and refusals.
#include <fmt/format.h>

#include <cmath>

#include "cli/run_hemibake.h"
#include "core/constants.h"
#include "io/bake_file.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

class Render : public CliTest {
 protected:
  void make_bake(const std::string& options = "--amplitude 0.1") const {
    write_map("map.exr", SyntheticKind::kBricks, 20, 16);
    run_well("bake map.exr -o bake.exr --rays 64 --links links.h5 " + options);
  }
  void write_colors(const std::string& name, const Grid<glm::vec3>& colors) const {
    const std::array planes{Plane{"R", &colors.values[0].x, 3}, Plane{"G", &colors.values[0].y, 3},
                            Plane{"B", &colors.values[0].z, 3}};
    write_image(folder_ / name, colors.width, colors.height, planes, nlohmann::ordered_json::object());
  }
  Grid<glm::vec3> picture(const std::string& name) const { return read_color_image(folder_ / name).colors; }
  static std::vector<std::string> names_of(const nlohmann::json& list) {
    std::vector<std::string> names;
    for (const auto& entry : list) names.push_back(entry.at("name"));
    return names;
  }
  // Returns the largest difference of two pictures over `scale`.
  double difference(const std::string& a, const std::string& b) const {
    const Grid<glm::vec3> first = picture(a), second = picture(b);
    EXPECT_EQ(first.size(), second.size());
    double worst = 0;
    for (size_t i = 0; i < first.size(); ++i)
      for (int c = 0; c < 3; ++c)
        worst = std::max(worst, std::abs(double{first[i][c]} - double{second[i][c]}));
    return worst;
  }
};

TEST_F(Render, EverythingOfABake) {
  make_bake();
  const nlohmann::json json = run_json("render bake.exr -o out --view-width 64");
  EXPECT_TRUE(json.at("missing").empty()) << json.at("missing");
  for (const auto& entry : json.at("pictures"))
    for (const auto& file : entry.at("files"))
      EXPECT_TRUE(fs::is_regular_file(folder_.path() / "out" / file.get<std::string>())) << file;
  for (const char* name : {"ao_only",
                           "visibility_only",
                           "model",
                           "bounce_map",
                           "truth",
                           "triptych",
                           "difference_bounce_map",
                           "difference_visibility_only",
                           "visibility",
                           "bounce",
                           "difference_model",
                           "bounce_00",
                           "bounces",
                           "saturation",
                           "energy",
                           "ao",
                           "bent_normals",
                           "estimators",
                           "view_truth",
                           "overview"})
    EXPECT_THAT(names_of(json.at("pictures")), Contains(name));
  // ρE/π of the bake's own channels.
  const Bake bake = read_bake(folder_ / "bake.exr").bake;
  const Grid<glm::vec3> ao_only = picture("out/ao_only.exr"), direct = picture("out/bounce_00.exr");
  const Grid<glm::vec3> visibility_only = picture("out/visibility_only.exr"),
                        bounce_map = picture("out/bounce_map.exr");
  for (size_t i = 0; i < ao_only.size(); ++i) {
    EXPECT_NEAR(ao_only[i].y, 0.6 * bake.visible_fraction[i], 1e-6);
    EXPECT_NEAR(visibility_only[i].y, 0.6 * bake.visibility[i], 1e-6);
    // At the albedo of the map's second texture, .9, the light is that texture.
    EXPECT_NEAR(bounce_map[i].x, 0.9 * bake.bounce[i], 1e-6);
    EXPECT_NEAR(direct[i].z, 0.2 * bake.irradiance[0][i] / kPi, 1e-6);
  }
  EXPECT_LT(std::abs(json["errors"]["model"]["bias_over_mean"].get<double>()),
            std::abs(json["errors"]["ao_only"]["bias_over_mean"].get<double>()))
      << "the model is nearer to the truth than AO alone";
  EXPECT_LT(json["errors"]["bounce_map"]["rms_over_mean"].get<double>(),
            json["errors"]["model"]["rms_over_mean"].get<double>())
      << "two textures tell more than one";
  EXPECT_TRUE(json.at("pictures")[0].contains("clipped_above_white"));
}

TEST_F(Render, SameBytesAtAnyThreadCount) {
  make_bake();
  const std::string options = " --view-width 32 --sun 30,40,3 --sky-rays 16 --links ../links.h5";
  write_colors("sky.exr", Grid<glm::vec3>(8, 4, glm::vec3(0.5f, 0.7f, 1)));
  std::vector<std::string> folders;
  for (const char* threads : {"1", "2"}) {
    const std::string folder = std::string("with_") + threads;
    fs::create_directory(folder_ / folder);
    const CommandResult result =
        run("render ../bake.exr -o out --sky ../sky.exr --threads " + std::string(threads) + options,
            "cd " + folder + " &&");
    ASSERT_EQ(result.exit_code, 0) << result.standard_error;
    folders.push_back(folder);
  }
  size_t files = 0;
  for (const auto& entry : fs::directory_iterator(folder_.path() / "with_1" / "out")) {
    const auto other = folder_.path() / "with_2" / "out" / entry.path().filename();
    EXPECT_TRUE(read_bytes(entry.path()) == read_bytes(other)) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 40u);
}

// Compares an albedo map of one value with ρᵇ, traced again and from the links file.
TEST_F(Render, ConstantAlbedoMapIsPowersOfAlbedo) {
  make_bake();
  write_colors("albedo.exr", Grid<glm::vec3>(20, 16, glm::vec3(0.9f, 0.6f, 0.2f)));
  run_well("render bake.exr -o powers --pictures light,bounces");
  run_well("render bake.exr -o again --albedo albedo.exr --pictures light,bounces");
  run_well("render bake.exr -o links --albedo albedo.exr --links links.h5 --pictures light,bounces");
  // Floats of at most 1, twice rounded; the rest of the series amplifies that by 1/(1 − q)² of a small term.
  EXPECT_LT(difference("powers/truth.exr", "again/truth.exr"), 1e-6);
  EXPECT_EQ(difference("powers/model.exr", "again/model.exr"), 0);
  for (int b = 0; b < 6; ++b)
    EXPECT_LT(difference(fmt::format("powers/bounce_{:02}.exr", b), fmt::format("again/bounce_{:02}.exr", b)),
              1.2e-7)
        << b;
  // Links read back are the same to 10⁻⁴ of their quantum, which is a twelfth of the mean weight
  // or less.
  EXPECT_LT(difference("again/truth.exr", "links/truth.exr"), 1e-4 / 12);
}

// Every model by its formula, with an albedo map: each texel counts with its own albedo.
TEST_F(Render, ModelsOfVisibilityAndTheBounceMap) {
  make_bake();
  Grid<glm::vec3> albedo(20, 16);
  for (size_t i = 0; i < albedo.size(); ++i)
    albedo[i] = glm::vec3(0.1f, 0.5f, 0.9f) + 0.1f * (static_cast<float>(i % 7) / 7);
  write_colors("albedo.exr", albedo);
  const Bake bake = read_bake(folder_ / "bake.exr").bake;
  const auto expect_light = [&](const std::string& options, const auto& light) {
    const nlohmann::json json = run_json(
        "render bake.exr -o out --links links.h5 --albedo albedo.exr --pictures light,saturation " + options);
    EXPECT_THAT(names_of(json.at("pictures")),
                AllOf(Contains("model"), Contains("saturation"), Contains("tau")));
    const Grid<glm::vec3> model = picture("out/model.exr");
    for (size_t i = 0; i < model.size(); ++i)
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(model[i][c], albedo[i][c] * light(i, double{albedo[i][c]}), 1e-6) << options;
  };
  const auto escaping = [&](size_t i, double g, double rho) {
    return 1 - (1 - double{bake.visibility[i]}) * (1 - rho) / (1 - rho + rho * g);
  };
  expect_light("--model visibility --constants none",
               [&](size_t i, double rho) { return escaping(i, double{bake.visibility[i]}, rho); });
  expect_light("--model visibility-ao --constants none",
               [&](size_t i, double rho) { return escaping(i, double{bake.visible_fraction[i]}, rho); });
  expect_light("--model visibility-normal", [&](size_t i, double rho) {
    return escaping(i, std::min(1.0, double{bake.visibility[i]} * (1.3 - 0.6 * double{bake.normals[i].z})),
                    rho);
  });
  double sum = 0, squares = 0;
  for (const float v : bake.visibility.values) sum += double{v}, squares += double{v} * double{v};
  const double m = (sum - squares) / (static_cast<double>(bake.visibility.size()) - sum);
  expect_light("--model visibility-ao-mean", [&](size_t i, double rho) {
    const double ao = bake.visible_fraction[i];
    return escaping(i, ao * (1 + m) / (1 + ao), rho);
  });
  // The g with which the light at .9 is that of the map.
  expect_light("--model bounce-map", [&](size_t i, double rho) {
    const double blocked = 1 - double{bake.visibility[i]}, missing = 1 - double{bake.bounce[i]};
    return escaping(i, missing > 0 ? (0.1 / 0.9) * (blocked - missing) / missing : 1, rho);
  });
  // The second picture of the bounce map would be the same as the model's.
  EXPECT_FALSE(fs::exists(folder_ / "out" / "bounce_map.exr"));
  // Fitted to the map it is no farther from the truth than without constants.
  const auto rms_of = [&](const std::string& options) {
    return run_json("render bake.exr -o out --pictures light " + options)["errors"]["model"]["rms_over_mean"]
        .get<double>();
  };
  EXPECT_LT(rms_of("--model visibility"), 1.2 * rms_of("--model visibility --constants none"));
  EXPECT_LT(rms_of("--model jimenez"), 0.1);
  EXPECT_LT(rms_of("--model bounce-map"), rms_of("--model visibility-ao"));
}

// Bakes of older versions have neither V by name nor the bounce map.
TEST_F(Render, BakesOfOlderVersions) {
  make_bake();
  run_well("render bake.exr -o new --pictures light --model visibility-ao");
  BakeFile file = read_bake(folder_ / "bake.exr");
  file.bake.visibility = file.bake.bounce = {};
  write_bake(folder_ / "old.exr", file.bake, file.provenance);
  const nlohmann::json json = run_json("render old.exr -o old --pictures light,planes --model visibility-ao");
  EXPECT_THAT(names_of(json.at("missing")), testing::UnorderedElementsAre("bounce_map", "bounce"));
  EXPECT_LT(difference("new/visibility_only.exr", "old/visibility_only.exr"), 1e-6);
  // The curves of the fits take V from the same light.
  EXPECT_LT(difference("new/model.exr", "old/model.exr"), 1e-6);
  expect_refusal("render old.exr -o none --model bounce-map",
                 "old.exr: has no plane bounce, expected the bounce map of a bake with --bounce-albedo");
  EXPECT_FALSE(fs::exists(folder_ / "none"));
}

// Light reflected by a neighbour has the neighbour's colour: a black and red checker reflects no green.
TEST_F(Render, NeighboursReflectTheirOwnColor) {
  make_bake();
  Grid<glm::vec3> albedo(20, 16, glm::vec3(0));
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 10; ++x) albedo(x, y) = {0.8f, 0, 0};
  for (int y = 0; y < 16; ++y)
    for (int x = 10; x < 20; ++x) albedo(x, y) = {0, 0.5f, 0};
  write_colors("albedo.exr", albedo);
  run_well("render bake.exr -o out --albedo albedo.exr --links links.h5 --pictures bounces");
  const Grid<glm::vec3> bounce = picture("out/bounce_01.exr"), direct = picture("out/bounce_00.exr");
  double far = 0, near_wall = 0;
  for (int y = 0; y < 16; ++y) {
    near_wall += bounce(5, y).x;
    far += bounce(15, y).x;
    EXPECT_EQ(direct(15, y).x, 0);
  }
  EXPECT_GT(near_wall, 0);
  EXPECT_EQ(far, 0) << "red light on a green wall is not seen";
}

// 8-bit images are sRGB unless told otherwise.
TEST_F(Render, EncodingOfTheAlbedoMap) {
  make_bake();
  write_png8_rgb(folder_ / "albedo.png", Grid<glm::vec3>(20, 16, glm::vec3(0.8f)),
                 nlohmann::ordered_json::object());
  const auto red_of = [&](const std::string& options) {
    run_well("render bake.exr -o out --albedo albedo.png --links links.h5 --pictures light " + options);
    return picture("out/ao_only.exr")[0].x;
  };
  const float linear = red_of("--albedo-encoding linear"), decoded = red_of("");
  EXPECT_NEAR(decoded / linear, std::pow((0.8 + 0.055) / 1.055, 2.4) / 0.8, 1e-5);
  EXPECT_EQ(red_of("--albedo-encoding srgb"), decoded);
}

// Nine coefficients of a uniform sky give what a uniform sky gives.
TEST_F(Render, HarmonicsOfAUniformSky) {
  make_bake();
  write_bytes(folder_ / "sky.txt",
              "# L00 = 1/Y00\n3.5449077018110318 3.5449077018110318,3.5449077018110318\n" +
                  std::string("0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n"));
  run_well("render bake.exr -o uniform --pictures light");
  run_well("render bake.exr -o sh --sky sh sky.txt --links links.h5 --sky-rays 1 --pictures light");
  EXPECT_LT(difference("uniform/ao_only.exr", "sh/ao_only.exr"), 1e-6);
  // Links read back are the same to 10⁻⁴ of their quantum, which is a twelfth of the mean weight
  // or less.
  EXPECT_LT(difference("uniform/truth.exr", "sh/truth.exr"), 1e-4 / 12);
}

TEST_F(Render, SunIsNotDarkenedByAo) {
  make_bake();
  run_well("render bake.exr -o night --pictures light");
  run_well("render bake.exr -o day --sun 300,35,2 --links links.h5 --pictures light");
  const Grid<glm::vec3> ao_night = picture("night/ao_only.exr"), ao_day = picture("day/ao_only.exr");
  const Grid<glm::vec3> model_night = picture("night/model.exr"), model_day = picture("day/model.exr");
  double lit = 0, shadowed = 0;
  for (size_t i = 0; i < ao_day.size(); ++i) {
    const double sun = double{ao_day[i].x} - double{ao_night[i].x};
    EXPECT_NEAR(sun, double{model_day[i].x} - double{model_night[i].x}, 3e-7);
    lit += sun > 0;
    shadowed += sun < 1e-7;
  }
  EXPECT_GT(lit, 0);
  EXPECT_GT(shadowed, 0);
}

TEST_F(Render, WhatABakeLacksIsSaid) {
  make_bake();
  const auto missing = [&](const std::string& bake_options) {
    run_well("bake map.exr -o part.exr --rays 16 " + bake_options);
    return names_of(run_json("render part.exr -o part --view-width 32").at("missing"));
  };
  EXPECT_THAT(missing("--outputs ao"), AllOf(Contains("truth"), Contains("model"), Contains("bent_normals")));
  EXPECT_THAT(missing("--outputs irradiance"), AllOf(Contains("ao_only"), Contains("model"), Contains("ao")));
  EXPECT_THAT(missing("--outputs normal"), AllOf(Contains("truth"), Contains("ao_only")));
  EXPECT_THAT(missing("--bounces 0"), Contains("model"));
  EXPECT_THAT(missing("--amplitude 0"), Contains("model"));  // one AO value is no curve
  fs::rename(folder_ / "map.exr", folder_ / "elsewhere.exr");
  const nlohmann::json json = run_json("render bake.exr -o out --view-width 32");
  EXPECT_THAT(names_of(json.at("missing")), AllOf(Contains("views"), Contains("estimators")));
  EXPECT_THAT(json["light"]["map"].get<std::string>(), HasSubstr("is not there"));
  EXPECT_TRUE(fs::exists(folder_ / "out" / "triptych.png"));
}

// An earlier run's picture must not pass for this one's.
TEST_F(Render, PicturesOfAnEarlierRunGo) {
  make_bake();
  run_well("render bake.exr -o out --pictures light");
  write_bytes(folder_.path() / "out" / "mine.txt", "kept");
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "truth.exr"));
  run_well("render bake.exr -o out --pictures planes");
  EXPECT_FALSE(fs::exists(folder_.path() / "out" / "truth.exr"));
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "ao.png"));
  EXPECT_TRUE(fs::exists(folder_.path() / "out" / "mine.txt"));
}

TEST_F(Render, Extremes) {
  for (const std::string amplitude : {"0", "1e-6", "1e3"}) {
    make_bake("--amplitude " + amplitude);
    run_well("render bake.exr -o out --view-width 32 --sun 10,20,1e6");
    for (const char* model : {"visibility-ao", "bounce-map", "visibility --constants none"})
      run_well(fmt::format(
          "render bake.exr -o out --pictures light,saturation --albedo 0,0.999999,1 --model {}", model));
  }
  write_map("one.exr", Grid<float>(1, 1, 0.5f));
  run_well("bake one.exr -o one_bake.exr --rays 16");
  run_well("render one_bake.exr -o one --view-width 32 --sun 10,90,1");
  write_map("row.exr", SyntheticKind::kNoise, 7, 1);
  run_well("bake row.exr -o row_bake.exr --rays 16");
  run_well("render row_bake.exr -o row --view-width 32 --albedo 1");
  make_bake("--patches texels --edge open");
  run_well("render bake.exr -o texels --view-width 32 --albedo 0 --sun 10,20,1 --links links.h5");
}

TEST_F(Render, BadInput) {
  make_bake();
  write_bytes(folder_ / "text.txt", "no numbers\n");
  write_bytes(folder_ / "few.txt", "1 2 3\n");
  write_bytes(folder_ / "cut.png", "\x89PNG\r\n\x1a\n");
  write_colors("small.exr", Grid<glm::vec3>(2, 2, glm::vec3(0.5f)));
  write_colors("bright.exr", Grid<glm::vec3>(20, 16, glm::vec3(1.5f)));
  write_colors("negative.exr", Grid<glm::vec3>(4, 2, glm::vec3(-1)));
  write_map("other.exr", SyntheticKind::kNoise, 20, 16);
  run_well("bake other.exr -o other_bake.exr --rays 4 --links other.h5");
  const auto expect = [&](const std::string& arguments, const testing::Matcher<std::string>& line) {
    expect_refusal("render " + arguments, AllOf(line, HasSubstr("expected")));
  };
  expect("none.exr -o out", StartsWith("none.exr: No such file"));
  expect("map.exr -o out", StartsWith("map.exr: "));
  expect("-o out", StartsWith("BAKE: is missing"));
  expect("bake.exr -o none/out", StartsWith("none/out: could not make the folder"));
  expect("bake.exr -o bake.exr", StartsWith("bake.exr: could not make the folder"));
  expect("bake.exr -o out --albedo 1.5", StartsWith("--albedo: '1.5'"));
  expect("bake.exr -o out --albedo 0.1,0.2", StartsWith("--albedo: '0.1,0.2'"));
  expect("bake.exr -o out --albedo none.png", StartsWith("none.png: No such file"));
  expect("bake.exr -o out --albedo cut.png", StartsWith("cut.png: "));
  expect("bake.exr -o out --albedo small.exr", StartsWith("small.exr: is 2 x 2 texels"));
  expect("bake.exr -o out --albedo bright.exr", StartsWith("bright.exr: reflectance 1.5 at texel 0,0"));
  expect("bake.exr -o out --sky sh", StartsWith("--sky: sh by itself"));
  expect("bake.exr -o out --sky sh text.txt", StartsWith("text.txt:1"));
  expect("bake.exr -o out --sky sh few.txt", StartsWith("few.txt: holds 3 numbers, expected 27"));
  expect("bake.exr -o out --sky negative.exr", StartsWith("negative.exr: negative radiance"));
  expect("bake.exr -o out --sky none.hdr", StartsWith("none.hdr: No such file"));
  expect("bake.exr -o out --sun 1,2", StartsWith("--sun: '1,2'"));
  expect("bake.exr -o out --sun 0,0,1", StartsWith("--sun: "));
  expect("bake.exr -o out --sun 0,nan,1", StartsWith("--sun: "));
  expect("bake.exr -o out --camera 0,1", StartsWith("--camera: "));
  expect("bake.exr -o out --constants none", StartsWith("--constants: the model bounded has none"));
  expect("bake.exr -o out --fit few.txt", StartsWith("few.txt"));
  expect("bake.exr -o out --albedo bright.exr --links other.h5", testing::_);
  expect("bake.exr -o out --sun 1,1,1 --links other.h5", StartsWith("other.h5: is of another map"));
  expect("bake.exr -o out --sun 1,1,1 --links map.exr", StartsWith("map.exr: "));
  fs::rename(folder_ / "map.exr", folder_ / "elsewhere.exr");
  expect("bake.exr -o out --sun 1,1,1", AllOf(StartsWith("map.exr: "), HasSubstr("is not there")));
  write_bytes(folder_ / "map.exr", "another map");
  expect("bake.exr -o out --sun 1,1,1", StartsWith("map.exr: not the file the bake was made from"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

// In `--sky uniform BAKE.exr` the bake is not read as the sky's file.
TEST_F(Render, SkyBeforeTheBake) {
  make_bake();
  run_well("render -o out --pictures planes --sky uniform bake.exr");
}

TEST_F(Render, InterruptedWhileTracing) {
  write_map("map.exr", SyntheticKind::kBricks, 128, 128);
  run_well("bake map.exr -o bake.exr --rays 4");
  std::string coefficients;
  for (int i = 0; i < 27; ++i) coefficients += "0.5\n";
  write_bytes(folder_ / "sky.txt", coefficients);
  const auto files = listing();
  // 3 billion rays to the sky.
  const CommandResult result = run_shell(fmt::format(
      "cd '{}' && exec timeout --foreground --preserve-status --signal INT 1.5 '{}' render bake.exr -o out "
      "--sky sh sky.txt --sky-rays 65536 --threads 1",
      folder_.path().string(), HEMIBAKE_BINARY));
  EXPECT_EQ(result.exit_code, 130) << result.standard_error;
  EXPECT_EQ(result.standard_output, "");
  EXPECT_EQ(listing(), files);
}

}  // namespace
}  // namespace hemibake
