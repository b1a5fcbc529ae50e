// The steps of bounce maps, and the loss that is stated of them, against searches and sums of their own.
#include "textures/bounce_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/bake.h"
#include "core/constants.h"
#include "model/closed_forms.h"
#include "sampling/low_discrepancy.h"
#include "support/maps.h"
#include "support/threads.h"
#include "textures/bounce_map_loss.h"
#include "textures/light.h"

namespace hemibake {
namespace {

constexpr double kBounceAlbedo = 0.9, kMeanWeight = 1.5;

// Light that no bounce map holds exactly: the escape share falls with the albedo.
MappedLight random_light(uint64_t index) {
  const double visibility = unit_interval(mix_bits(1, 0, index));
  const double escape = unit_interval(mix_bits(1, 1, index)), fall = unit_interval(mix_bits(1, 2, index));
  const auto irradiance = [&](double albedo) {
    return escape_irradiance(visibility, escape * (1 - 0.5 * fall * albedo), albedo);
  };
  MappedLight light{visibility, irradiance(kBounceAlbedo), {}};
  std::ranges::transform(kBounceMapAlbedos, light.irradiance.begin(), irradiance);
  return light;
}

double squares_of(const MappedLight& truth, double visibility, double bounce) {
  double sum = std::pow(visibility - truth.visibility, 2);
  for (size_t a = 0; a < kBounceMapAlbedos.size(); ++a) {
    const double model = bounce_map_irradiance(visibility, bounce, kBounceMapAlbedos[a], kBounceAlbedo);
    sum += std::pow(model - truth.irradiance[a], 2);
  }
  return sum;
}

// Σ e² + 1.5 n ē², as declared.
double objective(const LightBlock& block, const StoredBlock& stored, int steps) {
  const auto count = static_cast<double>(block.size());
  MappedLight mean;
  double squares = 0, visibility = 0, bounce = 0;
  for (size_t i = 0; i < block.size(); ++i) {
    const double v = stored[i].visibility / static_cast<double>(steps);
    const double b = stored[i].bounce / static_cast<double>(steps);
    squares += squares_of(block.texels[i], v, b);
    visibility += v / count;
    bounce += b / count;
    mean.visibility += block.texels[i].visibility / count;
    for (size_t a = 0; a < mean.irradiance.size(); ++a)
      mean.irradiance[a] += block.texels[i].irradiance[a] / count;
  }
  return squares + kMeanWeight * count * squares_of(mean, visibility, bounce);
}

TEST(BounceMap, ChosenStepsNeverLeaveMoreThanRoundedOnes) {
  for (const int steps : {255, 65535, 15})
    for (int k = 0; k < 200; ++k) {
      const LightBlock block = block_at(0, 0, 1 + k % 4, 1 + k / 4 % 4, [&](size_t texel) {
        return random_light(static_cast<uint64_t>(k) * 16 + texel);
      });
      const StoredBlock rounded = round_steps(block, steps),
                        chosen = choose_steps(block, steps, kBounceAlbedo);
      EXPECT_LE(objective(block, chosen, steps), objective(block, rounded, steps) * (1 + 1e-12));
      for (size_t i = 0; i < block.size(); ++i) {
        EXPECT_LE(std::abs(rounded[i].visibility - chosen[i].visibility), 1);
        EXPECT_LE(std::abs(rounded[i].bounce - chosen[i].bounce), 3);
        EXPECT_GE(chosen[i].bounce, chosen[i].visibility);
        EXPECT_TRUE(chosen[i].visibility >= 0 && chosen[i].bounce <= steps);
      }
    }
}

// One texel alone: of all the pairs within reach none is nearer.
TEST(BounceMap, ASingleTexelHasTheBestPair) {
  for (uint64_t k = 0; k < 300; ++k) {
    const LightBlock block = block_at(0, 0, 1, 1, [&](size_t) { return random_light(k); });
    const StoredPair rounded = round_steps(block, 255)[0],
                     chosen = choose_steps(block, 255, kBounceAlbedo)[0];
    const double left = squares_of(block.texels[0], chosen.visibility / 255.0, chosen.bounce / 255.0);
    for (int v = std::max(rounded.visibility - 1, 0); v <= std::min(rounded.visibility + 1, 255); ++v)
      for (int b = std::max(rounded.bounce - 3, v); b <= std::min(rounded.bounce + 3, 255); ++b)
        EXPECT_LE(left, squares_of(block.texels[0], v / 255.0, b / 255.0) * (1 + 1e-12));
  }
}

TEST(BounceMap, EndsOfTheRangeAreExact) {
  const auto flat = [](double visibility, double light) {
    MappedLight texel{visibility, light, {}};
    texel.irradiance.fill(light);
    return texel;
  };
  for (const MappedLight& light : {flat(1, 1), flat(0, 0)}) {
    const BounceMap map = choose_bounce_map(5, 3, 255, kBounceAlbedo, [&](size_t) { return light; });
    for (size_t i = 0; i < map.bounce.size(); ++i) {
      EXPECT_EQ(map.visibility[i], light.visibility);
      EXPECT_EQ(map.bounce[i], light.bounce);
    }
  }
}

Bake small_bake(const Surface& surface, int bounces) {
  LoadedMap map;
  map.surface = surface;
  MapSettings unused;
  BakeSettings settings;
  settings.rays = 8;
  settings.bounces = bounces;
  resolve_defaults(unused, settings, [](const std::string&) { return true; });
  settings.bounce_albedo = kBounceAlbedo;
  return bake(map, settings, {}).planes;
}

BounceMap chosen_of(const Bake& bake) {
  return choose_bounce_map(bake.width, bake.height, 255, bake.bounce_albedo,
                           [&](size_t texel) { return mapped_light_at(bake, texel); });
}

TEST(BounceMap, IsTheSameAtAnyThreadCount) {
  const Bake bake = small_bake(synthetic_surface(SyntheticKind::kBricks, 45, 38), 6);
  set_thread_count(1);
  const BounceMap map = chosen_of(bake);
  const std::optional<BounceMapLoss> loss = bounce_map_loss(bake);
  for (const int threads : {2, 5}) {
    set_thread_count(threads);
    const BounceMap other = chosen_of(bake);
    EXPECT_EQ(map.visibility.values, other.visibility.values);
    EXPECT_EQ(map.bounce.values, other.bounce.values);
    const std::optional<BounceMapLoss> other_loss = bounce_map_loss(bake);
    for (size_t s = 0; s < loss->stored.size(); ++s)
      EXPECT_EQ(loss->stored[s].mean_rms(), other_loss->stored[s].mean_rms());
  }
  set_thread_count(0);
}

Grid<double> rounded_to(const Grid<float>& plane, double steps) {
  Grid<double> result(plane.width, plane.height);
  for (size_t i = 0; i < plane.size(); ++i)
    result[i] =
        steps > 0 ? std::round(static_cast<double>(plane[i]) * steps) / steps : static_cast<double>(plane[i]);
  return result;
}

Grid<double> filtered(const Grid<double>& plane, int box) {
  Grid<double> result(plane.width / box, plane.height / box);
  for (int y = 0; y < result.height * box; ++y)
    for (int x = 0; x < result.width * box; ++x) result(x / box, y / box) += plane(x, y) / (box * box);
  return result;
}

// The same errors from whole planes: stored, filtered, sorted.
MapError error_of(const Bake& bake, const StoredLoss& stored, double albedo) {
  const BounceMap chosen = chosen_of(bake);
  const double steps = stored.bits == 16 ? 65535 : 0;
  const Grid<double> visibility =
      filtered(rounded_to(stored.bits == 8 ? chosen.visibility : bake.visibility, steps), stored.box);
  const Grid<double> bounce =
      filtered(rounded_to(stored.bits == 8 ? chosen.bounce : bake.bounce, steps), stored.box);
  Grid<double> truth(bake.width, bake.height);
  for (size_t i = 0; i < truth.size(); ++i) truth[i] = irradiance_at(bake, i, albedo);
  truth = filtered(truth, stored.box);
  std::vector<double> errors;
  double squares = 0;
  for (size_t i = 0; i < truth.size(); ++i) {
    errors.push_back(
        std::abs(bounce_map_irradiance(visibility[i], bounce[i], albedo, bake.bounce_albedo) - truth[i]));
    squares += errors.back() * errors.back();
  }
  std::ranges::sort(errors);
  const auto rank = static_cast<size_t>(std::ceil(0.999 * static_cast<double>(errors.size())));
  return {std::sqrt(squares / static_cast<double>(errors.size())), errors[rank - 1], errors.back()};
}

TEST(BounceMapLoss, IsThatOfWholePlanes) {
  const Bake bakes[] = {small_bake(synthetic_surface(SyntheticKind::kBricks, 45, 38), 6),
                        small_bake(white_noise_surface(14, 13, 0.4), 3)};
  for (const Bake& bake : bakes) {
    const std::optional<BounceMapLoss> loss = bounce_map_loss(bake);
    ASSERT_TRUE(loss);
    EXPECT_EQ(loss->stored.size(), 9u);
    for (const StoredLoss& stored : loss->stored)
      for (size_t a = 0; a < kBounceMapAlbedos.size(); ++a) {
        const MapError expected = error_of(bake, stored, kBounceMapAlbedos[a]), error = stored.by_albedo[a];
        SCOPED_TRACE(testing::Message()
                     << stored.bits << " bits, box " << stored.box << ", albedo " << kBounceMapAlbedos[a]);
        EXPECT_NEAR(error.rms, expected.rms, 1e-7);  // 8 bits are floats here
        EXPECT_NEAR(error.largest, expected.largest, 1e-6);
        EXPECT_GE(error.percentile, expected.percentile - 1e-6);
        EXPECT_LE(error.percentile, expected.percentile + 0.001 * std::sqrt(expected.percentile) + 1e-6);
      }
  }
}

TEST(BounceMapLoss, IsNothingOnFlatGroundAndFiniteOnRoughOne) {
  const auto loss_of = [](const Surface& surface) { return bounce_map_loss(small_bake(surface, 4)).value(); };
  const BounceMapLoss flat = loss_of(synthetic_surface(SyntheticKind::kFlat, 8, 8));
  for (const StoredLoss& stored : flat.stored) EXPECT_EQ(stored.largest(), 0);
  const BounceMapLoss one = loss_of(synthetic_surface(SyntheticKind::kFlat, 1, 1));
  EXPECT_EQ(one.stored.size(), 3u);
  EXPECT_EQ(one.find(8, 2), nullptr);
  EXPECT_EQ(one.find(8, 1)->largest(), 0);
  for (const double amplitude : {1e-6, 1000.0}) {
    const BounceMapLoss rough = loss_of(white_noise_surface(9, 6, amplitude));
    for (const StoredLoss& stored : rough.stored)
      EXPECT_TRUE(stored.mean_rms() >= 0 && stored.largest() <= 1);
  }
}

TEST(BounceMapLoss, NeedsTheConvergedPlaneAndBounces) {
  Bake bake = small_bake(white_noise_surface(8, 8, 0.3), 3);
  EXPECT_TRUE(bounce_map_loss(bake));
  bake.irradiance.pop_back();
  EXPECT_FALSE(bounce_map_loss(bake));
  bake = small_bake(white_noise_surface(8, 8, 0.3), 3);
  bake.bounce = {};
  EXPECT_FALSE(bounce_map_loss(bake));
}

// Light of two decays, of which the bounces that are stored show the slow one only in part.
TEST(TexturesLight, ItsTailLeadsToThePlaneAtItsAlbedo) {
  const auto share = [](double albedo, double part, double escape) {  // Σ_b of part·escape·(ρ(1−escape))^b
    return part * escape / (1 - albedo * (1 - escape));
  };
  const auto truth = [&](double albedo) { return share(albedo, 0.7, 0.6) + share(albedo, 0.3, 0.08); };
  Bake bake;
  bake.width = bake.height = 1;
  for (int b = 0; b < 6; ++b)
    bake.irradiance.emplace_back(
        1, 1, static_cast<float>(kPi * (0.7 * 0.6 * std::pow(0.4, b) + 0.3 * 0.08 * std::pow(0.92, b))));
  bake.visibility = Grid<float>(1, 1, static_cast<float>(truth(0)));
  const double by_bounces = irradiance_at(bake, 0, 0.95);
  bake.bounce = Grid<float>(1, 1, static_cast<float>(truth(kBounceAlbedo)));
  bake.bounce_albedo = kBounceAlbedo;
  EXPECT_NEAR(irradiance_at(bake, 0, kBounceAlbedo), truth(kBounceAlbedo), 1e-6);
  EXPECT_EQ(irradiance_by_bounces(bake, 0, 0.95), by_bounces);
  for (const double albedo : {0.5, 0.8, 0.95, 0.999})
    EXPECT_LE(std::abs(irradiance_at(bake, 0, albedo) - truth(albedo)),
              0.5 * std::abs(irradiance_by_bounces(bake, 0, albedo) - truth(albedo)) + 1e-6)
        << albedo;
  EXPECT_EQ(irradiance_at(bake, 0, 0), bake.visibility[0]);
  EXPECT_LE(irradiance_at(bake, 0, 1), 1);
}

}  // namespace
}  // namespace hemibake
