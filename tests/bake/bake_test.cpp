// The one function that bakes, called as a library: a map from memory, a context, a result.
#include "bake/bake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "support/maps.h"
#include "tracers/slice/slice.h"
#include "transport/bounces.h"

namespace hemibake {
namespace {

LoadedMap noise_map(int side) {
  LoadedMap map;
  map.surface = synthetic_surface(SyntheticKind::kNoise, side, side);
  return map;
}

BakeSettings settings_with(int rays, int bounces) {
  MapSettings unused;
  BakeSettings settings;
  settings.rays = rays;
  settings.bounces = bounces;
  resolve_defaults(unused, settings, [](const std::string&) { return true; });
  return settings;
}

// The steps one by one give the same planes, to the bit.
TEST(Bake, IsItsSteps) {
  const LoadedMap map = noise_map(16);
  const BakeResult result = bake(map, settings_with(16, 3), {});
  SliceOptions slices;
  slices.azimuths = 16;
  const LightTransport transport = trace_surface(*make_slice_tracer(map.surface, slices), KeptLinks::kAll);
  BounceOptions options;
  options.bounces = 3;
  const Bounces bounces = bounce_light(transport, options);
  EXPECT_EQ(result.planes.visible_fraction.values, transport.visible_fraction.values);
  ASSERT_EQ(result.planes.irradiance.size(), 4u);
  for (size_t b = 0; b < 4; ++b) EXPECT_EQ(result.planes.irradiance[b].values, bounces.irradiance[b].values);
  EXPECT_EQ(result.planes.total.values, bounces.total.values);
  EXPECT_EQ(result.counts.rays, transport.counts.rays);
  EXPECT_GT(result.links, 0u);
  EXPECT_TRUE(result.energy && result.errors && result.bounces);
  EXPECT_FALSE(result.transport || result.reached || result.choice);
}

TEST(Bake, GivesWhatIsAskedForAndNoMore) {
  BakeSettings settings = settings_with(8, 3);
  settings.outputs = {BakeOutput::kAo};
  const BakeResult only_ao = bake(noise_map(8), settings, {});
  EXPECT_FALSE(only_ao.planes.visible_fraction.empty());
  EXPECT_TRUE(only_ao.planes.irradiance.empty() && only_ao.planes.normals.empty());
  EXPECT_EQ(only_ao.links, 0u);
  EXPECT_FALSE(only_ao.bounces || only_ao.energy);
  settings.outputs.clear();
  settings.trace_form_factors = settings.keep_transport = true;
  const BakeResult only_links = bake(noise_map(8), settings, {});
  ASSERT_TRUE(only_links.transport);
  EXPECT_EQ(only_links.transport->final_gather.rows, 64u);
  EXPECT_TRUE(only_links.planes.visible_fraction.empty());
}

TEST(Bake, EndsWhereTheCallerCancels) {
  const std::atomic<bool> cancel{true};
  Context context;
  context.cancel = &cancel;
  EXPECT_THROW(bake(noise_map(16), settings_with(16, 3), context), Cancelled);
  // The context was in force for that call only.
  EXPECT_NO_THROW(bake(noise_map(8), settings_with(4, 1), {}));
}

TEST(Bake, SameBytesWhateverTheThreads) {
  Context one, three;
  one.threads = 1;
  three.threads = 3;
  const LoadedMap map = noise_map(24);
  const BakeResult a = bake(map, settings_with(8, 2), one), b = bake(map, settings_with(8, 2), three);
  EXPECT_EQ(a.planes.total.values, b.planes.total.values);
  EXPECT_EQ(a.planes.residual.values, b.planes.residual.values);
}

// A library error names the setting; the command line has other words for it.
TEST(Bake, RefusesWhatMemoryDoesNotHold) {
  BakeSettings settings = settings_with(8, 2);
  settings.memory_gib = 1e-6;
  try {
    bake(noise_map(8), settings, {});
    FAIL() << "expected a refusal";
  } catch (const SettingError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("at most the 1e-06 GiB of memory: "));
    EXPECT_THAT(error.in_file("map.png").with_prefix("--"),
                testing::AllOf(testing::StartsWith("map.png: the bake needs"),
                               testing::HasSubstr("GiB of --memory: ")));
  }
  settings.limit_memory = false;
  EXPECT_NO_THROW(bake(noise_map(8), settings, {}));
}

// What a header is refused for, the plan would refuse too.
TEST(Bake, NeedsAtLeastWhatItsHeaderTells) {
  using Outputs = std::vector<BakeOutput>;
  for (const Edge edge : {Edge::kWrap, Edge::kOpen})
    for (const TracerKind tracer : {TracerKind::kSlice, TracerKind::kEmbree, TracerKind::kMarch})
      for (const Outputs& outputs : {Outputs{BakeOutput::kAo}, BakeSettings().outputs}) {
        LoadedMap map;
        map.settings.edge = edge;
        map.surface = synthetic_surface(SyntheticKind::kNoise, 19, 7, {}, {}, edge);
        BakeSettings settings;
        settings.tracer = tracer;
        settings.outputs = outputs;
        if (tracer == TracerKind::kMarch && edge != Edge::kWrap) continue;
        resolve_defaults(map.settings, settings, [](const std::string&) { return false; });
        const double least = least_bake_bytes(19, 7, map.settings, settings);
        const double planned = static_cast<double>(prepare_bake(map, settings).plan.memory_bytes());
        EXPECT_GT(least, 0);
        EXPECT_LE(least, planned - static_cast<double>(BakePlan::kProgramBytes));
      }
}

}  // namespace
}  // namespace hemibake
