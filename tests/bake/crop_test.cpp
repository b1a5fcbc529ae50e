#include "bake/crop.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/maps.h"

namespace hemibake {
namespace {

BakeResult bake_with_margin(const LoadedMap& map, int margin) {
  MapSettings of_map;
  of_map.edge = map.surface.edge;
  BakeSettings settings;
  settings.rays = 16;
  settings.bounces = 2;
  settings.margin = margin;
  resolve_defaults(of_map, settings, [](const std::string&) { return true; });
  validate(of_map, settings, [](const std::string&) { return false; });
  return bake(map, settings, Context());
}

// A cropped bake is the crop of the whole one, byte for byte.
TEST(Crop, PlanesAreThoseOfTheWholeBake) {
  for (const Edge edge : {Edge::kOpen, Edge::kGround}) {
    LoadedMap map;
    map.surface = synthetic_surface(SyntheticKind::kTerrain, 25, 20, 0.3, {}, edge);
    const Bake whole = bake_with_margin(map, 0).planes, cropped = bake_with_margin(map, 4).planes;
    ASSERT_EQ(cropped.width, 17);
    ASSERT_EQ(cropped.height, 12);
    EXPECT_EQ(cropped.visible_fraction.values, crop_plane(whole.visible_fraction, 4).values);
    EXPECT_EQ(cropped.visibility.values, crop_plane(whole.visibility, 4).values);
    EXPECT_EQ(cropped.total.values, crop_plane(whole.total, 4).values);
    EXPECT_EQ(cropped.residual.values, crop_plane(whole.residual, 4).values);
    EXPECT_EQ(cropped.bounce.values, crop_plane(whole.bounce, 4).values);
    EXPECT_EQ(cropped.normals.values, crop_plane(whole.normals, 4).values);
    EXPECT_EQ(cropped.bent_normals.values, crop_plane(whole.bent_normals, 4).values);
    ASSERT_EQ(cropped.irradiance.size(), whole.irradiance.size());
    for (size_t b = 0; b < whole.irradiance.size(); ++b)
      EXPECT_EQ(cropped.irradiance[b].values, crop_plane(whole.irradiance[b], 4).values);
    EXPECT_EQ(cropped.visible_fraction(0, 0), whole.visible_fraction(4, 4));
  }
}

TEST(Crop, RefusesWhatMakesNoSense) {
  LoadedMap map;
  map.surface = synthetic_surface(SyntheticKind::kTerrain, 16, 9, 0.3, {}, Edge::kOpen);
  EXPECT_EQ(bake_with_margin(map, 4).planes.height, 1);
  EXPECT_THROW(bake_with_margin(map, 5), InputError);
  map.surface.edge = Edge::kWrap;
  EXPECT_THROW(bake_with_margin(map, 1), InputError);
}

}  // namespace
}  // namespace hemibake
