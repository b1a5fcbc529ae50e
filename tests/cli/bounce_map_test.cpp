// Bounce maps through the real binary: their loss is that of the files written, their bytes those chosen.
#include "textures/bounce_map.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/run_hemibake.h"
#include "io/bake_file.h"
#include "io/image_io.h"
#include "model/closed_forms.h"
#include "textures/light.h"

namespace hemibake {
namespace {

class BounceMapFiles : public CliTest {
 protected:
  void SetUp() override {
    write_map("map.exr", SyntheticKind::kBricks, 42, 30);
    of_bake_ = run_json("bake map.exr -o b.exr --rays 8 --bounces 8")["bounce_map"];
    bake_ = read_bake(folder_ / "b.exr").bake;
  }

  Grid<float> read(const std::string& name, const std::string& channel = "") const {
    return read_height_map(folder_ / name, channel);
  }

  // Returns the mean over the albedos of the rms error of two planes.
  double mean_rms(const Grid<float>& visibility, const Grid<float>& bounce) const {
    double mean = 0;
    for (const double albedo : kBounceMapAlbedos) {
      double squares = 0;
      for (size_t i = 0; i < bounce.size(); ++i) {
        const double model =
            bounce_map_irradiance<double>(visibility[i], bounce[i], albedo, bake_.bounce_albedo);
        squares += std::pow(model - irradiance_at(bake_, i, albedo), 2);
      }
      mean += std::sqrt(squares / static_cast<double>(bounce.size())) / kBounceMapAlbedos.size();
    }
    return mean;
  }

  // Returns the entry of a loss for bits and box.
  static nlohmann::json stored(const nlohmann::json& loss, int bits, int box) {
    for (const nlohmann::json& entry : loss["stored"])
      if (entry["bits"] == bits && entry["box"] == box) return entry;
    return nullptr;
  }

  nlohmann::json of_bake_;
  Bake bake_;
};

TEST_F(BounceMapFiles, LeaveWhatIsSaid) {
  for (const int bits : {8, 16}) {
    const nlohmann::json json =
        run_json(fmt::format("textures b.exr -o t --maps visibility,bounce,ao --format png{}", bits));
    const double rms = mean_rms(read("t/b_visibility.png"), read("t/b_bounce.png"));
    EXPECT_NEAR(stored(of_bake_, bits, 1)["mean_rms"].get<double>(), rms, 1e-5) << bits;
    EXPECT_EQ(json["textures"][1]["bounce_map"], of_bake_);
    EXPECT_FALSE(json["textures"][0].contains("bounce_map"));
  }
  EXPECT_EQ(of_bake_["albedos"], kBounceMapAlbedos);
  EXPECT_EQ(of_bake_["bounce_albedo"], 0.9);
}

TEST_F(BounceMapFiles, OfEightBitsAreChosenTogether) {
  const auto holds = [](const nlohmann::json& json, size_t texture) {
    return json["textures"][texture]["holds"].get<std::string>();
  };
  const nlohmann::json pair = run_json("textures b.exr -o pair --maps visibility,bounce --format png8");
  const nlohmann::json one =
      run_json("textures b.exr -o one --maps bounce-map,visibility --format png8 --threads 1");
  EXPECT_THAT(holds(pair, 0), testing::HasSubstr("chosen together with the bounce"));
  EXPECT_THAT(holds(pair, 1), testing::HasSubstr("chosen together with the visibility"));
  EXPECT_THAT(holds(one, 0), testing::HasSubstr("chosen together"));
  EXPECT_THAT(holds(one, 1), testing::Not(testing::HasSubstr("chosen")));
  const Grid<float> visibility = read("pair/b_visibility.png"), bounce = read("pair/b_bounce.png");
  EXPECT_EQ(read("one/b_bounce_map.png", "R").values, visibility.values);
  EXPECT_EQ(read("one/b_bounce_map.png", "G").values, bounce.values);

  run_well("textures b.exr -o v --maps visibility,ao --format png8");
  run_well("textures b.exr -o e --maps bounce --format png8");
  const Grid<float> plain = read("v/b_visibility.png"), plain_bounce = read("e/b_bounce.png");
  EXPECT_EQ(read("one/b_visibility.png").values, plain.values);
  EXPECT_LT(mean_rms(visibility, bounce), 0.95 * mean_rms(plain, plain_bounce));
  for (size_t i = 0; i < plain.size(); ++i) {
    EXPECT_LE(std::abs(plain[i] - bake_.visibility[i]), 0.5f / 255 + 1e-6f);
    EXPECT_LE(std::abs(visibility[i] - bake_.visibility[i]), 1.5f / 255 + 1e-6f);
    EXPECT_LE(std::abs(bounce[i] - bake_.bounce[i]), 3.5f / 255 + 1e-6f);
  }
}

TEST_F(BounceMapFiles, DitheredOnesAreNot) {
  const nlohmann::json json = run_json("textures b.exr -o d --maps bounce-map --format png8 --dither");
  EXPECT_THAT(json["textures"][0]["holds"].get<std::string>(), testing::Not(testing::HasSubstr("chosen")));
  EXPECT_FALSE(json["textures"][0].contains("bounce_map"));
  const Grid<float> visibility = read("d/b_bounce_map.png", "R");
  for (size_t i = 0; i < visibility.size(); ++i)
    EXPECT_LE(std::abs(visibility[i] - bake_.visibility[i]), 1.0f / 255 + 1e-6f);
}

TEST_F(BounceMapFiles, TheSummarySaysWhatTheyLeave) {
  using testing::HasSubstr;
  EXPECT_THAT(run_well("bake map.exr -o again.exr --rays 8").standard_output,
              HasSubstr("\nbounce map: off by 0.00"));
  EXPECT_THAT(run_well("bake map.exr -o ao.exr --rays 8 --outputs ao").standard_output,
              testing::Not(HasSubstr("bounce map")));
  EXPECT_TRUE(run_json("bake map.exr -o ao.exr --rays 8 --outputs ao")["bounce_map"].is_null());
  const nlohmann::json flat = run_json("bake map.exr -o flat.exr --rays 8 --amplitude 0")["bounce_map"];
  for (const nlohmann::json& entry : flat["stored"]) EXPECT_EQ(entry["mean_rms"], 0);
}

}  // namespace
}  // namespace hemibake
