#include "reference/path_tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <regex>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "reference/lit_path_tracer.h"
#include "reference/random.h"
#include "reference/texel_sample.h"
#include "support/threads.h"
#include "surface/facets.h"
#include "surface/synthetic/synthetic.h"
#include "tracers/embree/embree.h"

namespace hemibake {
namespace {

Surface make_noise(int width, Edge edge = Edge::kWrap) {
  SyntheticOptions options;
  options.width = options.height = width;
  const SyntheticMap map = synthesize(SyntheticKind::kNoise, options);
  return make_surface(map.heights, 1, map.recommended_amplitude_m, edge);
}

std::vector<uint32_t> all_texels(const Surface& surface) {
  std::vector<uint32_t> texels(surface.texel_count());
  std::iota(texels.begin(), texels.end(), 0u);
  return texels;
}

// All texels of a map: mean over them.
RefereeInterval map_mean(const RefereeEstimates& measured, int quantity, double confidence) {
  TexelSample sample;
  std::vector<double> values, variances;
  for (size_t i = 0; i < measured.receivers(); ++i) {
    sample.texels.push_back(static_cast<uint32_t>(i));
    values.push_back(measured.mean[measured.index(i, quantity)]);
    variances.push_back(measured.variance[measured.index(i, quantity)]);
  }
  sample.strata.push_back({values.size(), values.size()});
  return mean_from_sample(sample, values, variances, confidence);
}

TEST(RefereeRandom, DirectionsAreCosineDistributed) {
  // Moments of the cosine lobe: mean cos = 2/3, mean cos² = 1/2, mean of the parts across = 0 and their
  // squares 1/4.
  RefereeRandom random(1, 2, 3);
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.5, 0.8)),
                   across = glm::normalize(glm::cross(normal, {0, 0, 1}));
  const int count = 1'000'000;
  double cosine = 0, cosine2 = 0, side = 0, side2 = 0;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 d = random_cosine_direction(normal, random);
    ASSERT_NEAR(glm::length(d), 1, 1e-12);
    ASSERT_GE(glm::dot(d, normal), 0);
    cosine += glm::dot(d, normal) / count;
    cosine2 += std::pow(glm::dot(d, normal), 2) / count;
    side += glm::dot(d, across) / count;
    side2 += std::pow(glm::dot(d, across), 2) / count;
  }
  const double tolerance = 4 * 0.5 / std::sqrt(count);  // no spread is above ½
  EXPECT_NEAR(cosine, 2.0 / 3, tolerance);
  EXPECT_NEAR(cosine2, 0.5, tolerance);
  EXPECT_NEAR(side, 0, tolerance);
  EXPECT_NEAR(side2, 0.25, tolerance);
}

TEST(RefereeRandom, UniformDirectionsAboutAnyNormal) {
  // Equal solid angles: the mean cosine is ½, the mean across 0, and the hemisphere is never left.
  for (const glm::dvec3& normal :
       {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::normalize(glm::dvec3(0.3, -0.5, 0.8))}) {
    glm::dvec3 mean(0);
    constexpr int kSide = 100;
    for (int i = 0; i < kSide * kSide; ++i) {
      const glm::dvec3 d = uniform_direction(normal, (i / kSide + 0.5) / kSide, (i % kSide + 0.5) / kSide);
      ASSERT_NEAR(glm::length(d), 1, 1e-12);
      ASSERT_GE(glm::dot(d, normal), 0);
      mean += d / double{kSide * kSide};
    }
    EXPECT_NEAR(glm::length(mean - 0.5 * normal), 0, 1e-12);
  }
}

TEST(Referee, FlatGroundIsExact) {
  const Surface surface = make_surface(Grid<float>(8, 8, 0.3f), 1, 1, Edge::kWrap);
  const RefereeEstimates measured = referee_texels(surface, all_texels(surface), {});
  for (size_t i = 0; i < measured.receivers(); ++i) {
    EXPECT_EQ(measured.mean[measured.index(i, 0)], 1);
    EXPECT_EQ(measured.mean[measured.index(i, 1)], 0);
    EXPECT_EQ(measured.mean[measured.index(i, 3)], 1);
    EXPECT_EQ(referee_interval(measured, i, 0, 0.99).half_width, 0);
  }
  for (const double ao : referee_visible_fractions(surface, all_texels(surface), 100, 0)) EXPECT_EQ(ao, 1);
}

TEST(Referee, BouncesAddUpToTheTotals) {
  // With a limit at the last bounce measured for itself, each group's total is the sum of its parts.
  const Surface surface = make_noise(32);
  RefereeOptions options;
  options.bounces = 4;
  options.totals = {{1, 4}, {0.3, 4}};
  const std::vector<uint32_t> texels{5, 300, 1000};
  const RefereeEstimates measured = referee_texels(surface, texels, options);
  for (size_t i = 0; i < texels.size(); ++i) {
    double at_1 = 0, at_03 = 0;
    for (int b = 0; b <= 4; ++b) {
      at_1 += measured.mean[measured.index(i, b)];
      at_03 += std::pow(0.3, b) * measured.mean[measured.index(i, b)];
    }
    EXPECT_NEAR(measured.mean[measured.index(i, 5)], at_1, 1e-12);
    EXPECT_NEAR(measured.mean[measured.index(i, 6)], at_03, 1e-12);
  }
}

TEST(Referee, AllLightArrivesInTheEnd) {
  const Surface surface = make_noise(16);
  RefereeOptions options;
  options.paths = 128;
  options.totals = {{1, RefereeTotal::kUnlimited}};
  const RefereeEstimates measured = referee_texels(surface, all_texels(surface), options);
  ASSERT_EQ(measured.truncated_rays, 0u);
  for (size_t i = 0; i < measured.receivers(); ++i)
    EXPECT_NEAR(measured.mean[measured.index(i, 3)], 1, 1e-12);
}

TEST(Referee, RouletteAgreesWithSplitting) {
  // The total at albedo 0.7 with E_1 … E_12 split and with nothing but E_0: the same light.
  const Surface surface = make_noise(32);
  RefereeOptions split, roulette;
  split.paths = roulette.paths = 512;
  split.bounces = 12;
  roulette.bounces = 0;
  split.totals = roulette.totals = {{0.7, RefereeTotal::kUnlimited}};
  roulette.seed = 1;
  const RefereeInterval a = map_mean(referee_texels(surface, all_texels(surface), split), 13, 0.99994);
  const RefereeInterval b = map_mean(referee_texels(surface, all_texels(surface), roulette), 1, 0.99994);
  EXPECT_NEAR(a.mean, b.mean, std::hypot(a.half_width, b.half_width));
  EXPECT_LT(a.half_width + b.half_width, 0.01);
}

TEST(Referee, ThreadsDoNotChangeABit) {
  const Surface surface = make_noise(16);
  RefereeOptions options;
  options.seed = 7;
  set_thread_count(1);
  const RefereeEstimates texels_1 = referee_texels(surface, all_texels(surface), options);
  const RefereeEstimates area_1 = referee_area(surface, options);
  set_thread_count(3);
  const RefereeEstimates texels_3 = referee_texels(surface, all_texels(surface), options);
  const RefereeEstimates area_3 = referee_area(surface, options);
  set_thread_count(0);
  EXPECT_EQ(texels_1.mean, texels_3.mean);
  EXPECT_EQ(texels_1.variance, texels_3.variance);
  EXPECT_EQ(texels_1.rays, texels_3.rays);
  EXPECT_EQ(area_1.mean, area_3.mean);
  EXPECT_EQ(area_1.variance, area_3.variance);
}

TEST(Referee, ATexelIsTheSameInAnyCompany) {
  const Surface surface = make_noise(16);
  const RefereeEstimates all = referee_texels(surface, all_texels(surface), {});
  const std::vector<uint32_t> one{77};
  const RefereeEstimates alone = referee_texels(surface, one, {});
  for (int q = 0; q < all.quantities; ++q)
    EXPECT_EQ(all.mean[all.index(77, q)], alone.mean[alone.index(0, q)]);
}

TEST(Referee, LiftDoesNotMatter) {
  const Surface surface = make_noise(64);
  RefereeOptions options;
  options.paths = 256;
  const RefereeEstimates standard = referee_texels(surface, all_texels(surface), options);
  options.seed = 1;
  for (const double lift : {1e-9, 1e-4, 1e-3, 1e-2}) {
    options.lift_texels = lift;
    const RefereeEstimates other = referee_texels(surface, all_texels(surface), options);
    for (int q = 0; q < standard.quantities; ++q) {
      const RefereeInterval a = map_mean(standard, q, 0.99994), b = map_mean(other, q, 0.99994);
      EXPECT_NEAR(a.mean, b.mean, std::hypot(a.half_width, b.half_width))
          << "quantity " << q << ", lift " << lift;
      EXPECT_LT(a.half_width, 0.02 * a.mean) << "quantity " << q;
    }
  }
}

TEST(Referee, AreaMeanOfDirectLightIsOpeningOverArea) {
  const Surface surface = make_noise(64);
  double area = 0;
  for (uint32_t f = 0; f < facet_count(surface); ++f) area += 0.5 * facet_area_ratio(surface, f);
  RefereeOptions options;
  options.paths = 200'000;
  options.bounces = 0;
  const RefereeInterval direct = referee_interval(referee_area(surface, options), 0, 0, 0.99994);
  EXPECT_TRUE(direct.contains(surface.texel_count() / area))
      << direct.mean << " expected " << surface.texel_count() / area;
  EXPECT_LT(direct.half_width, 0.01 * direct.mean);
}

TEST(Referee, DirectLightAgreesWithTheEmbreeTracer) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen, Edge::kGround}) {
    const Surface surface = make_noise(48, edge);
    RayOptions rays;
    const auto tracer = make_embree_tracer(surface, rays);
    double embree = 0;
    for (uint32_t texel = 0; texel < surface.texel_count(); ++texel) {
      Row row;
      TracerCounts counts;
      tracer->trace_texel(texel, false, row, counts);
      embree += row.direct_over_pi / surface.texel_count();
    }
    RefereeOptions options;
    options.paths = 512;
    options.bounces = 0;
    options.totals.clear();
    const RefereeInterval direct =
        map_mean(referee_texels(surface, all_texels(surface), options), 0, 0.99994);
    // 256 rotated Hammersley rays a texel, rms error 0.01 each, over 48² texels: 4 standard errors.
    const double embree_noise = 4 * 0.01 / 48;
    EXPECT_NEAR(direct.mean, embree, direct.half_width + embree_noise);
  }
}

TEST(Referee, RefusesOptionsOutOfRange) {
  const Surface surface = make_noise(8);
  const std::vector<uint32_t> texels{0};
  RefereeOptions options;
  options.paths = 0;
  EXPECT_THROW(referee_texels(surface, texels, options), InputError);
  options = {};
  options.totals = {{1.5, RefereeTotal::kUnlimited}};
  EXPECT_THROW(referee_texels(surface, texels, options), InputError);
  options = {};
  options.totals = {{0.5, 1}};
  EXPECT_THROW(referee_texels(surface, texels, options), InputError);
  options = {};
  options.lift_texels = 0;
  EXPECT_THROW(referee_area(surface, options), InputError);
}

// The judge is worth something as long as it shares nothing with what it judges.
TEST(Referee, IncludesOnlyTheSurfaceTheCoreAndItself) {
  const std::regex own_header("#include \"(?!surface/|core/|reference/)");
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(HEMIBAKE_SOURCE_DIR) / "src/reference")) {
    if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
    ++files;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);)
      EXPECT_FALSE(std::regex_search(line, own_header)) << entry.path() << ": " << line;
  }
  EXPECT_GE(files, 11);
}

double channel_sigma(const RefereeIrradiance& light, int c) { return std::sqrt(light.variance[c]); }

TEST(RefereeLit, FlatGroundUnderACosineSky) {
  // ∫ cos²θ dω = 2π/3, π under the constant channel, 0 under the black one.
  const Surface surface = make_surface(Grid<float>(4, 4), 1, 1, Edge::kWrap);
  RefereeLighting lighting{[](const glm::dvec3& d) { return glm::dvec3(d.z, 1, 0); },
                           Grid<glm::vec3>(1, 1, glm::vec3(0.5f))};
  const auto light = referee_lit_texels(surface, std::vector<uint32_t>{3}, lighting, 100'000, 1);
  EXPECT_NEAR(light[0].mean.r, 2 * kPi / 3, 4 * channel_sigma(light[0], 0));
  EXPECT_DOUBLE_EQ(light[0].mean.g, kPi);
  EXPECT_EQ(light[0].mean.b, 0);
}

TEST(RefereeLit, AlbedosAreThoseOfTheTotals) {
  // One colour everywhere: each channel is π times the total at its albedo.
  const Surface surface = make_noise(32);
  const std::vector<uint32_t> texels{10, 500, 900};
  RefereeOptions options;
  options.paths = 100'000;
  options.totals = {{0.2f}, {0.5f}, {0.9f}};
  const RefereeEstimates totals = referee_texels(surface, texels, options);
  const RefereeLighting lighting{[](const glm::dvec3&) { return glm::dvec3(1); },
                                 Grid<glm::vec3>(32, 32, glm::vec3(0.2f, 0.5f, 0.9f))};
  const auto light = referee_lit_texels(surface, texels, lighting, 100'000, 2);
  for (size_t i = 0; i < texels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const size_t total = totals.index(i, options.bounces + 1 + c);
      EXPECT_NEAR(light[i].mean[c] / kPi, totals.mean[total],
                  4 * std::sqrt(light[i].variance[c] / (kPi * kPi) + totals.variance[total]));
    }
}

TEST(RefereeLit, AnAlbedoMapIsReadWhereThePathHits) {
  // A groove along y, one wall white, the other black: a texel halfway up the black wall gets one bounce off
  // the white one and nothing more, E_0 + E_1 of the white wall's hits; the white wall's gets none from the
  // black.
  Grid<float> heights(8, 8);
  Grid<glm::vec3> albedo(8, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 8; ++x) {
      heights(x, y) = static_cast<float>(std::min(x, 8 - x));
      albedo(x, y) = glm::vec3(x > 4 || x == 0 ? 1 : 0);
    }
  const Surface surface = make_surface(heights, 8, 1, Edge::kWrap);
  const RefereeLighting lighting{[](const glm::dvec3&) { return glm::dvec3(1); }, albedo};
  const std::vector<uint32_t> texels{2, 6};
  const auto light = referee_lit_texels(surface, texels, lighting, 50'000, 3);
  RefereeOptions options;
  options.paths = 50'000;
  const RefereeEstimates measured = referee_texels(surface, texels, options);
  const double black_wall = light[0].mean.r / kPi, white_wall = light[1].mean.r / kPi;
  // The map is blurred over one texel at the vertex and the ridge: bounds, not values.
  EXPECT_GT(black_wall, measured.mean[measured.index(0, 0)] + 0.7 * measured.mean[measured.index(0, 1)]);
  EXPECT_LT(black_wall, measured.mean[measured.index(0, 0)] + measured.mean[measured.index(0, 1)] + 0.05);
  EXPECT_LT(white_wall, measured.mean[measured.index(1, 0)] + 0.5 * measured.mean[measured.index(1, 1)]);
}

TEST(RefereeLit, RefusesMapsThatDoNotFit) {
  const Surface surface = make_noise(8);
  const std::vector<uint32_t> texels{0};
  const auto sky = [](const glm::dvec3&) { return glm::dvec3(1); };
  EXPECT_THROW(referee_lit_texels(surface, texels, {sky, Grid<glm::vec3>(7, 8)}, 100, 0), InputError);
  EXPECT_THROW(referee_lit_texels(surface, texels, {sky, Grid<glm::vec3>(1, 1, glm::vec3(1.1f))}, 100, 0),
               InputError);
}

}  // namespace
}  // namespace hemibake
