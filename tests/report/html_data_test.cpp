// Numbers of a page: errors over the texels against light whose formula is known.
#include "report/html_data.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/constants.h"
#include "model/closed_forms.h"

namespace hemibake {
namespace {

using testing::ElementsAre;

constexpr int kSide = 12, kBounces = 8;
constexpr double kBounceAlbedo = 0.85;

// Every texel has a V and a g of its own: E_b/π = (1 − V) g (1 − g)^(b−1), whose sum is escape_irradiance.
struct EscapeWorld {
  Bake bake;
  std::vector<double> visibility, escape;

  EscapeWorld() {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(0.1, 0.9);
    bake.width = bake.height = kSide;
    const Grid<float> empty(kSide, kSide);
    bake.visible_fraction = bake.visibility = bake.bounce = empty;
    bake.irradiance.assign(kBounces + 1, empty);
    bake.bounce_albedo = kBounceAlbedo;
    for (size_t i = 0; i < empty.size(); ++i) {
      const double v = visibility.emplace_back(uniform(random)), g = escape.emplace_back(uniform(random));
      bake.visible_fraction[i] = static_cast<float>(uniform(random));
      bake.visibility[i] = static_cast<float>(v);
      bake.bounce[i] = static_cast<float>(escape_irradiance(v, g, kBounceAlbedo));
      bake.irradiance[0][i] = static_cast<float>(kPi * v);
      for (int b = 1; b <= kBounces; ++b)
        bake.irradiance[static_cast<size_t>(b)][i] =
            static_cast<float>(kPi * (1 - v) * g * std::pow(1 - g, b - 1));
    }
  }

  // Returns the rms of light(texel) − truth at an albedo.
  template <class Light>
  double rms(double albedo, const Light& light) const {
    double sum = 0;
    for (size_t i = 0; i < visibility.size(); ++i) {
      const double difference = light(i) - escape_irradiance(visibility[i], escape[i], albedo);
      sum += difference * difference;
    }
    return std::sqrt(sum / static_cast<double>(visibility.size()));
  }
};

std::vector<std::string> ids_of(const std::vector<ReportModel>& models) {
  std::vector<std::string> ids;
  for (const ReportModel& model : models) ids.push_back(model.id);
  return ids;
}

TEST(HtmlData, ModelsAreThoseThatTheBakeHasThePlanesOf) {
  Bake bake = EscapeWorld().bake;
  EXPECT_THAT(ids_of(report_models({}, &bake)),
              ElementsAre("visibility-ao", "visibility", "bounce-map", "notes"));
  EXPECT_THAT(ids_of(report_models({}, nullptr)), ElementsAre("visibility-ao", "visibility", "notes"));
  const auto map = report_models({}, &bake)[2];
  EXPECT_EQ(std::get<BounceMapModel>(map.model).bounce_albedo, kBounceAlbedo);
  EXPECT_EQ(map.title, "bounce map: V and E at ρ = 0.85");
  bake.bounce = bake.visibility = {};  // of an older version
  EXPECT_THAT(ids_of(report_models({}, &bake)), ElementsAre("visibility-ao", "visibility", "notes"));
  bake.irradiance.clear();
  EXPECT_THAT(ids_of(report_models({}, &bake)), ElementsAre("notes"));
}

TEST(HtmlData, ErrorsOverTheTexels) {
  const EscapeWorld world;
  ReportFolder folder;
  folder.bake = BakeFile{world.bake, {}};
  const std::vector<ReportModel> models = report_models({}, &world.bake);
  const ReportData data = gather_report(folder, models, {0.5, 0.5, 0.5});
  ASSERT_EQ(data.texel_errors.size(), 5U);
  ASSERT_EQ(data.other_models.size(), 3U);
  EXPECT_EQ(data.texel_errors.back().albedo, 0.95);
  for (const TexelErrors& errors : data.texel_errors) {
    const double albedo = errors.albedo;
    const auto& v = world.visibility;
    const auto ao = [&](size_t i) { return static_cast<double>(world.bake.visible_fraction[i]); };
    // Floats of E_b and of the map; the rest of the series amplifies the rounding of its last two terms.
    constexpr double kRounding = 2e-5;
    EXPECT_NEAR(errors.models[0],
                world.rms(albedo, [&](size_t i) { return escape_irradiance(v[i], ao(i), albedo); }),
                kRounding);
    EXPECT_NEAR(errors.models[1],
                world.rms(albedo, [&](size_t i) { return escape_irradiance(v[i], v[i], albedo); }),
                kRounding);
    EXPECT_LT(errors.models[2], kRounding)
        << "the bounce map is exact where light escapes at one rate a texel";
    EXPECT_NEAR(errors.others[0], world.rms(albedo, ao), kRounding);
    EXPECT_NEAR(errors.others[1], world.rms(albedo, [&](size_t i) { return v[i]; }), kRounding);
    EXPECT_NEAR(errors.others[2],
                world.rms(albedo, [&](size_t i) { return JimenezModel().total(v[i], albedo); }), kRounding);
  }
}

TEST(HtmlData, BounceMapLeavesNothingOfItsOwnKindOfLight) {
  EscapeWorld world;
  ReportFolder folder;
  folder.bake = BakeFile{world.bake, {}};
  const auto loss = gather_report(folder, {}, {}).bounce_map;
  ASSERT_TRUE(loss);
  EXPECT_EQ(loss->bounce_albedo, kBounceAlbedo);
  for (const MapError& error : loss->find(32, 1)->by_albedo) EXPECT_LT(error.rms, 2e-5);
  folder.bake->bake.bounce = {};
  EXPECT_FALSE(gather_report(folder, {}, {}).bounce_map);
}

TEST(HtmlData, MeanVisibilityOfBakesOfEitherVersion) {
  EscapeWorld world;
  double mean = 0;
  for (const double v : world.visibility) mean += v / static_cast<double>(world.visibility.size());
  for (const bool old : {false, true}) {
    ReportFolder folder;
    if (old) world.bake.visibility = world.bake.bounce = {};
    folder.bake = BakeFile{world.bake, {}};
    const ReportData data = gather_report(folder, report_models({}, &world.bake), {});
    EXPECT_NEAR(*data.means.visibility, mean, 1e-7);
  }
}

TEST(HtmlData, NoTruthWithoutBounces) {
  EscapeWorld world;
  world.bake.irradiance.resize(1);
  ReportFolder folder;
  folder.bake = BakeFile{world.bake, {}};
  EXPECT_TRUE(gather_report(folder, report_models({}, &world.bake), {}).texel_errors.empty());
}

TEST(HtmlData, ProbesHoldWhatModelsTake) {
  const EscapeWorld world;
  const std::vector<ReportModel> models = report_models({}, &world.bake);
  for (const ReportProbe& probe : report_probes(world.bake, models, 1, {0, kBounceAlbedo, 1})) {
    const size_t i = world.bake.bounce.index(probe.x, probe.y);
    EXPECT_EQ(probe.visibility, static_cast<double>(world.bake.visibility[i]));
    EXPECT_EQ(probe.bounce, static_cast<double>(world.bake.bounce[i]));
    EXPECT_NEAR(probe.models[2][0], probe.visibility, 1e-15);
    EXPECT_NEAR(probe.models[2][1], *probe.bounce, 1e-15);
    EXPECT_EQ(probe.models[2][2], 1);
  }
}

}  // namespace
}  // namespace hemibake
