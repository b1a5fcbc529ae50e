// Models at the texels of a bake: each gets what it takes, and its single bounces sum to its light.
#include "lighting/texel_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/constants.h"

namespace hemibake {
namespace {

constexpr std::array kUnitValues = {0.0, 1e-6, 0.2, 0.5, 0.9, 1.0};

std::vector<AnyModel> all_models() {
  return {VisibilityModel{},    VisibilityModel{0.1, 0.8},
          VisibilityAoModel{},  VisibilityAoModel{0.1, 0.8},
          MeanEscapeModel{0.4}, VisibilityNormalModel{},
          BounceMapModel{0.9},  BounceMapModel{0.5},
          BoundedModel{},       GuardedModel{},
          JimenezModel{}};
}

template <class Check>
void for_each_input(const Check& check) {
  for (const double ao : kUnitValues)
    for (const double visibility : kUnitValues)
      for (const double bounce : kUnitValues) check(TexelInputs{ao, visibility, bounce, 1 - ao});
}

TEST(TexelModel, EachTakesItsOwnAo) {
  const TexelInputs at{0.3, 0.45, 0.8, 0.7};
  EXPECT_EQ(model_irradiance(BoundedModel{}, at, 0.6), BoundedModel{}.total(0.3, 0.6));
  EXPECT_EQ(model_irradiance(GuardedModel{}, at, 0.6), GuardedModel{}.total(0.3, 0.6));
  EXPECT_EQ(model_irradiance(JimenezModel{}, at, 0.6), JimenezModel{}.total(0.45, 0.6));
  // 1 − (1 − V)(1 − ρ)/(1 − ρ + ρg).
  EXPECT_DOUBLE_EQ(model_irradiance(VisibilityModel{}, at, 0.6), 1 - 0.55 * 0.4 / (0.4 + 0.6 * 0.45));
  EXPECT_DOUBLE_EQ(model_irradiance(VisibilityAoModel{}, at, 0.6), 1 - 0.55 * 0.4 / (0.4 + 0.6 * 0.3));
  EXPECT_DOUBLE_EQ(model_irradiance(MeanEscapeModel{0.5}, at, 0.6),
                   1 - 0.55 * 0.4 / (0.4 + 0.6 * 0.3 * 1.5 / 1.3));
  EXPECT_DOUBLE_EQ(model_irradiance(VisibilityNormalModel{}, at, 0.6),
                   1 - 0.55 * 0.4 / (0.4 + 0.6 * 0.45 * (1.3 - 0.6 * 0.7)));
  EXPECT_DOUBLE_EQ(model_irradiance(BounceMapModel{0.6}, at, 0.6), 0.8);
}

TEST(TexelModel, LightIsInRangeAtAllExtremes) {
  for (const AnyModel& model : all_models())
    for_each_input([&](const TexelInputs& at) {
      for (const double albedo : {0.0, 0.5, 0.999999, 1.0}) {
        const double light = model_irradiance(model, at, albedo);
        EXPECT_GE(light, 0) << model.index();
        // The published constants of the cubic sum to 1.0001 at V = 1 and albedo 1.
        const double excess = std::holds_alternative<JimenezModel>(model) ? 1e-4 : 0;
        EXPECT_LE(light, 1 + excess + 1e-12) << model.index();
      }
    });
}

TEST(TexelModel, SingleBouncesSumToTheLight) {
  for (const AnyModel& model : all_models())
    for_each_input([&](const TexelInputs& at) {
      const auto split = split_bounces(model, at);
      ASSERT_EQ(!split, std::holds_alternative<JimenezModel>(model));
      if (!split) return;
      EXPECT_GE(split->escape, 0);
      EXPECT_LE(split->escape, 1);
      // A map whose second texture is lighter than one more bounce of all light asks for g > 1, which no
      // surface has.
      const auto* map = std::get_if<BounceMapModel>(&model);
      if (map) {
        const double r = map->bounce_albedo;
        if (at.bounce > escape_irradiance(at.visibility, 1.0, r)) return;
      }
      double sum = split->direct, power = 1;
      for (int b = 1; b < 400; ++b) {
        power *= 0.8;
        sum += power * (1 - split->direct) * split->escape * std::pow(1 - split->escape, b - 1);
      }
      EXPECT_NEAR(sum, model_irradiance(model, at, 0.8), 1e-12) << model.index();
    });
}

TEST(TexelModel, VisibilityOfOldBakesIsTheirDirectLight) {
  Bake bake;
  bake.width = 2;
  bake.height = 1;
  EXPECT_FALSE(has_visibility(bake));
  EXPECT_EQ(texel_inputs(bake, 1).visibility, 0);
  EXPECT_EQ(missing_plane(VisibilityModel{}, bake), "visibility");
  EXPECT_EQ(missing_plane(BoundedModel{}, bake), "ao");
  bake.irradiance.emplace_back(2, 1, static_cast<float>(kPi) * 0.25f);
  bake.irradiance[0][1] = 3.2f;  // a march gives a little more than π
  EXPECT_FLOAT_EQ(static_cast<float>(texel_inputs(bake, 0).visibility), 0.25f);
  EXPECT_EQ(texel_inputs(bake, 1).visibility, 1);
  EXPECT_EQ(missing_plane(JimenezModel{}, bake), "");
  EXPECT_EQ(missing_plane(VisibilityAoModel{}, bake), "ao");
  EXPECT_EQ(missing_plane(BounceMapModel{}, bake), "bounce");
  bake.visibility = Grid<float>(2, 1, 0.5f);
  bake.visible_fraction = Grid<float>(2, 1, 0.125f);
  bake.bounce = Grid<float>(2, 1, 0.75f);
  const TexelInputs at = texel_inputs(bake, 1);
  EXPECT_EQ(at.visibility, 0.5);
  EXPECT_EQ(at.ao, 0.125);
  EXPECT_EQ(at.bounce, 0.75);
  EXPECT_EQ(missing_plane(VisibilityNormalModel{}, bake), "normal");
  bake.normals = Grid<glm::vec3>(2, 1, glm::vec3(0, 0, 1));
  for (const AnyModel& model : all_models()) EXPECT_EQ(missing_plane(model, bake), "");
}

}  // namespace
}  // namespace hemibake
