// The plan before a bake, the replay of one texel, and that only the outputs asked for are made.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cli/run_hemibake.h"
#include "io/bake_file.h"
#include "io/image_io.h"
#include "io/links_file.h"

namespace hemibake {
namespace {

using testing::HasSubstr;

class Plan : public CliTest {};

TEST_F(Plan, SaysTheMemoryTheBakeThenTakes) {
  write_map("map.exr", SyntheticKind::kBricks, 256, 256);
  const auto before = listing();
  const nlohmann::json plan = run_json("bake map.exr --rays 64 --dry-run");
  EXPECT_THAT(run_well("bake map.exr --rays 64 --dry-run").standard_output, HasSubstr("memory "));
  EXPECT_EQ(listing(), before);
  const nlohmann::json bake = run_json("bake map.exr -o bake.exr --rays 64");
  const double ratio = bake.at("peak_memory_bytes").get<double>() / plan.at("memory_bytes").get<double>();
  EXPECT_NEAR(ratio, 1, 0.2);
  // Nodes of coarse and fine facets take a different number of rays each; the pilot knows their mix.
  EXPECT_NEAR(bake.at("rays_traced").get<double>() / plan.at("rays").get<double>(), 1, 0.01);
  // Four standard errors of some hundred rows are a few percent.
  EXPECT_NEAR(bake.at("links").get<double>() / plan.at("links").get<double>(), 1, 0.1);
}

// Spilled links give the same planes and links, and leave no file behind.
TEST_F(Plan, LinksThatDoNotFitGoToAFile) {
  write_map("map.exr", SyntheticKind::kNoise, 96, 96);
  const nlohmann::json plan = run_json("bake map.exr --rays 64 --converge 1e-4 --dry-run");
  EXPECT_FALSE(plan.at("links_spilled").get<bool>());
  const double enough = plan.at("memory_bytes").get<double>() - plan.at("link_bytes").get<double>() / 2;
  const std::string memory = fmt::format(" --memory {:.9f}", enough / (1 << 30));
  EXPECT_TRUE(
      run_json("bake map.exr --rays 64 --converge 1e-4 --dry-run" + memory).at("links_spilled").get<bool>());
  run_well("bake map.exr -o kept.exr --rays 64 --converge 1e-4 --links kept.h5");
  run_well("bake map.exr -o spilled.exr --rays 64 --converge 1e-4 --links spilled.h5" + memory);
  const Bake kept = read_bake(folder_ / "kept.exr").bake, spilled = read_bake(folder_ / "spilled.exr").bake;
  for (size_t b = 0; b < kept.irradiance.size(); ++b)
    EXPECT_EQ(kept.irradiance[b].values, spilled.irradiance[b].values);
  EXPECT_EQ(kept.total.values, spilled.total.values);
  const LinksFile kept_links = read_links(folder_ / "kept.h5"),
                  spilled_links = read_links(folder_ / "spilled.h5");
  ASSERT_EQ(kept_links.patch_form_factors->blocks.size(), spilled_links.patch_form_factors->blocks.size());
  for (size_t b = 0; b < kept_links.patch_form_factors->blocks.size(); ++b)
    EXPECT_EQ(kept_links.patch_form_factors->blocks[b].packed,
              spilled_links.patch_form_factors->blocks[b].packed);
  EXPECT_EQ(listing().size(), 5u);  // the map and four outputs
}

class Replay : public CliTest {
 protected:
  // rounding: largest error of the sums of weights.
  void expect_consistent(const std::string& options, double rounding) const {
    run_well("bake map.exr -o bake.exr " + options);
    const Bake bake = read_bake(folder_ / "bake.exr").bake;
    for (const auto& [x, y] : {std::pair{0, 0}, {31, 23}, {13, 7}}) {
      const nlohmann::json texel = run_json(fmt::format("bake map.exr --replay {},{} {}", x, y, options));
      double cosine_sum = 0, sky = 0, uniform_sum = 0, uniform_sky = 0, links = 0;
      for (const auto& ray : texel.at("rays")) {
        const double cosine = ray.at("cosine_weight"), uniform = ray.at("uniform_weight");
        cosine_sum += cosine;
        uniform_sum += uniform;
        if (ray.at("hit").get<bool>()) continue;
        sky += cosine;
        uniform_sky += uniform;
      }
      for (const auto& link : texel.at("links")) links += link.at("weight").get<double>();
      const double direct = texel.at("direct_over_pi"), ao = texel.at("ao");
      EXPECT_NEAR(cosine_sum, 1, rounding);
      EXPECT_NEAR(uniform_sum, 1, rounding);
      EXPECT_NEAR(direct, sky, rounding);
      EXPECT_NEAR(ao, uniform_sky, rounding);
      EXPECT_NEAR(links, 1 - sky, 1e-6);
      // The planes hold the same as floats.
      EXPECT_EQ(static_cast<float>(ao), bake.visible_fraction(x, y));
      EXPECT_NEAR(direct * M_PI, static_cast<double>(bake.irradiance[0](x, y)), 1e-6);
    }
  }
};

TEST_F(Replay, IsTheBakedTexel) {
  write_map("map.exr", SyntheticKind::kBricks, 32, 24);
  // Weights of rays are doubles, those of slices differences of floats.
  expect_consistent("--tracer embree --rays 64", 1e-12);
  expect_consistent("--rays 64 --patches texels --edge open --directions cosine --cone 170 --seed 9", 1e-12);
  expect_consistent("--rays 64", 1e-6);
}

class DefaultTracer : public CliTest {};

TEST_F(DefaultTracer, IsSlicesUnlessRaysAreAskedFor) {
  write_map("map.exr", SyntheticKind::kShapes, 8, 8);
  const auto expect = [&](const std::string& options, const std::string& tracer, int rays) {
    run_well("bake map.exr -o bake.exr --bounces 0 --outputs ao " + options);
    const Provenance made = read_bake(folder_ / "bake.exr").provenance;
    EXPECT_EQ(made.at("tracer").get<std::string>(), tracer) << options;
    EXPECT_EQ(made.at("rays").get<int>(), rays) << options;
  };
  expect("", "slice", 64);
  expect("--rays 16", "slice", 16);
  expect("--tracer embree", "embree", 256);
  expect("--tracer march", "march", 256);
  expect("--cone 90", "embree", 256);
  expect("--directions uniform", "embree", 256);
  expect("--rays 65537", "embree", 65537);
  EXPECT_EQ(run_hemibake("bake map.exr -o bake.exr --tracer slice --cone 90").exit_code, 2);
}

class Outputs : public CliTest {
 protected:
  std::set<std::string> channels_of(const std::string& options) const {
    run_well("bake map.exr -o bake.exr --rays 4 --bounces 2 " + options);
    const std::vector<std::string> channels = read_image_header(folder_ / "bake.exr").channels;
    return {channels.begin(), channels.end()};
  }
};

TEST_F(Outputs, AreExactlyThoseAskedFor) {
  write_map("map.exr", SyntheticKind::kShapes, 16, 16);
  const std::set<std::string> light = {"visibility", "irradiance.00", "irradiance.01", "irradiance.02",
                                       "total",      "residual",      "bounce"};
  using Names = std::set<std::string>;
  EXPECT_EQ(channels_of("--outputs ao"), Names({"ao", "visibility"}));
  EXPECT_EQ(channels_of("--outputs irradiance"), light);
  EXPECT_EQ(channels_of("--outputs bent,normal"),
            Names({"bent.X", "bent.Y", "bent.Z", "normal.X", "normal.Y", "normal.Z"}));
  Names all = light;
  all.insert({"ao", "bent.X", "bent.Y", "bent.Z", "normal.X", "normal.Y", "normal.Z"});
  EXPECT_EQ(channels_of(""), all);
  EXPECT_EQ(channels_of("--outputs normal,ao,bent,irradiance,ao"), all);
  // One bounce links no patches: the bounce map, all bounces at its albedo, would.
  run_well("bake map.exr -o one.exr --rays 4 --bounces 1 --outputs irradiance");
  const std::vector<std::string> one = read_image_header(folder_ / "one.exr").channels;
  EXPECT_EQ(std::set<std::string>(one.begin(), one.end()),
            Names({"visibility", "irradiance.00", "irradiance.01", "total", "residual"}));
}

TEST_F(Outputs, LinksOnlyWhereTheyAreNeeded) {
  write_map("map.exr", SyntheticKind::kBricks, 128, 128);
  const auto bake = [&](const std::string& options) {
    return run_json("bake map.exr -o bake.exr --rays 64 " + options);
  };
  const nlohmann::json whole = bake("");
  EXPECT_GT(whole.at("links"), 128 * 128);
  for (const std::string options :
       {"--outputs ao", "--outputs ao,bent,normal", "--outputs irradiance --bounces 0"}) {
    const nlohmann::json json = bake(options);
    EXPECT_FALSE(json.contains("links")) << options;
    EXPECT_FALSE(json.contains("row_sum_error")) << options;
    // Facets are not traced either.
    EXPECT_EQ(json.at("rays_traced"), 128 * 128 * 64) << options;
    // About 3 bytes per link less.
    EXPECT_LT(json.at("peak_memory_bytes").get<double>(),
              whole.at("peak_memory_bytes").get<double>() - 2 * whole.at("links").get<double>())
        << options;
  }
  EXPECT_TRUE(bake("--outputs ao --links links.h5").contains("links"));
}

}  // namespace
}  // namespace hemibake
