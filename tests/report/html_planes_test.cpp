// The planes of a page: what is unpacked again is the bake, to what pack_planes says.
#include "report/html_planes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "core/constants.h"
#include "core/error.h"

namespace hemibake {
namespace {

std::vector<uint8_t> bytes_of(const std::string& base64) {
  std::vector<uint8_t> bytes;
  uint32_t group = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    const int digit = c >= 'A' && c <= 'Z' ? c - 'A'
                      : c >= 'a'           ? c - 'a' + 26
                      : c >= '0'           ? c - '0' + 52
                      : c == '+'           ? 62
                                           : 63;
    group = group << 6 | static_cast<uint32_t>(digit);
    if ((bits += 6) >= 8) bytes.push_back(static_cast<uint8_t>(group >> (bits -= 8)));
  }
  return bytes;
}

// As the page does it (web/planes.ts).
std::vector<double> unpack(const PackedPlane& plane, int width, int height) {
  const auto count = static_cast<size_t>(width) * static_cast<size_t>(height);
  const std::vector<uint8_t> stream = bytes_of(plane.base64);
  std::vector<uint8_t> bytes(2 * count);
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(bytes.data(), &size, stream.data(), stream.size()), Z_OK);
  EXPECT_EQ(size, 2 * count);
  Grid<uint16_t> codes(width, height);
  std::vector<double> values(count);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const size_t i = codes.index(x, y);
      const int left = x > 0 ? codes(x - 1, y) : 0, above = y > 0 ? codes(x, y - 1) : 0;
      const int corner = x > 0 && y > 0 ? codes(x - 1, y - 1) : 0;
      const int predicted = std::clamp(left + above - corner, std::min(left, above), std::max(left, above));
      const int folded = bytes[i] | bytes[count + i] << 8;
      codes[i] = static_cast<uint16_t>(predicted + (folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2));
      values[i] = codes[i] * plane.step;
    }
  return values;
}

// Light as it falls: every bounce a random share of the one before.
Bake random_bake(int width, int height, int bounces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0, 1);
  Bake bake;
  bake.width = width;
  bake.height = height;
  bake.visible_fraction = Grid<float>(width, height);
  for (float& ao : bake.visible_fraction.values) ao = uniform(random);
  Grid<float> light(width, height, static_cast<float>(kPi));
  for (int b = 0; b < bounces; ++b) {
    for (float& value : light.values) value *= uniform(random);
    bake.irradiance.push_back(light);
  }
  return bake;
}

double largest_difference(const std::vector<double>& values, const Grid<float>& plane, int stride,
                          int width) {
  double largest = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const auto x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    largest = std::max(largest, std::abs(values[i] - plane(x * stride, y * stride)));
  }
  return largest;
}

void expect_round_trip(const Bake& bake, int largest_side) {
  const PackedPlanes packed = pack_planes(bake, largest_side);
  ASSERT_EQ(packed.planes.size(), bake.irradiance.size() + 1);
  EXPECT_LE(std::max(packed.width, packed.height), largest_side);
  double irradiance_error = 0;
  for (size_t p = 0; p < packed.planes.size(); ++p) {
    const std::vector<double> values = unpack(packed.planes[p], packed.width, packed.height);
    const double error = largest_difference(values, p == 0 ? bake.visible_fraction : bake.irradiance[p - 1],
                                            packed.stride, packed.width);
    // Half a step, and the rounding of the quotient.
    EXPECT_LE(error, packed.planes[p].step * (0.5 + 1e-9)) << packed.planes[p].name;
    if (p == 0)
      EXPECT_EQ(error, packed.ao_error);
    else
      irradiance_error = std::max(irradiance_error, error / kPi);
  }
  EXPECT_DOUBLE_EQ(irradiance_error, packed.irradiance_error_over_pi);
  EXPECT_LE(packed.total_error_over_pi,
            static_cast<double>(bake.irradiance.size()) * irradiance_error + 1e-12);
}

TEST(HtmlPlanes, ComeBackWithinHalfAStep) {
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 40}, {40, 1}, {37, 23}})
    for (const int side : {1000, 40, 7, 1}) expect_round_trip(random_bake(width, height, 6), side);
}

// V is E₀/π: a plane of its own only where there is no E₀.
TEST(HtmlPlanes, BounceMapAndVisibilityComeBack) {
  Bake bake = random_bake(13, 9, 2);
  bake.visibility = bake.visible_fraction;
  bake.bounce = bake.visible_fraction;
  for (float& value : bake.bounce.values) value = std::sqrt(value);
  const auto expect_plane = [](const PackedPlanes& packed, const char* name, const Grid<float>& plane) {
    const PackedPlane& last = packed.planes.back();
    EXPECT_EQ(last.name, name);
    const std::vector<double> values = unpack(last, packed.width, packed.height);
    EXPECT_LE(largest_difference(values, plane, packed.stride, packed.width), last.step * (0.5 + 1e-9));
  };
  const PackedPlanes with_light = pack_planes(bake, 13);
  ASSERT_EQ(with_light.planes.size(), 4U);
  expect_plane(with_light, "bounce", bake.bounce);
  EXPECT_GT(with_light.bounce_error, 0);
  EXPECT_LE(with_light.bounce_error, 0.5 / 65535 * (1 + 1e-9));
  bake.irradiance.clear();
  bake.bounce = {};
  const PackedPlanes without = pack_planes(bake, 4);
  ASSERT_EQ(without.planes.size(), 2U);
  expect_plane(without, "visibility", bake.visibility);
}

TEST(HtmlPlanes, ExtremesComeBack) {
  Bake bake = random_bake(9, 9, 3);
  bake.visible_fraction = Grid<float>(9, 9, 1.0F);
  bake.irradiance[0] = Grid<float>(9, 9, static_cast<float>(kPi));
  bake.irradiance[1] = Grid<float>(9, 9, 0.0F);
  expect_round_trip(bake, 9);
  // More than π, as a march with a narrow cone gives it; far more, which no bake gives.
  for (const float above : {1.03F, 1e6F}) {
    bake.irradiance[2] = Grid<float>(9, 9, static_cast<float>(kPi) * above);
    expect_round_trip(bake, 9);
  }
}

// The bar of the report: what the probe shows is within 1e-3, with 20 bounces and more.
TEST(HtmlPlanes, SumOfManyBouncesStaysWithinTheBar) {
  const PackedPlanes packed = pack_planes(random_bake(64, 64, 41), 64);
  // 41 bounces, half of π/65535 each.
  EXPECT_LE(packed.total_error_over_pi, 41 * 0.5 / 65535 * (1 + 1e-9));
  EXPECT_LT(packed.total_error_over_pi, 1e-3);
}

TEST(HtmlPlanes, EveryThirdTexelIsATexelOfTheBake) {
  Bake bake = random_bake(10, 7, 1);
  const PackedPlanes packed = pack_planes(bake, 4);
  EXPECT_EQ(packed.stride, 3);
  EXPECT_EQ(packed.width, 4);
  EXPECT_EQ(packed.height, 3);
}

TEST(HtmlPlanes, LateBouncesAreSmall) {
  Bake bake = random_bake(128, 128, 2);
  for (float& value : bake.irradiance[1].values) value *= 1e-4F;
  const PackedPlanes packed = pack_planes(bake, 128);
  // E₀ fills 16 bits with noise: 128·128·2 bytes, 4/3 of that as text. The other one has seven levels of the
  // common step, differences of at most 4 bits, in eight bits at the very most.
  EXPECT_GT(packed.planes[1].base64.size(), 128U * 128 * 2);
  EXPECT_LT(packed.planes[2].base64.size(), 128U * 128);
}

TEST(HtmlPlanes, NothingIsPackedOfNothing) {
  const PackedPlanes packed = pack_planes(Bake{}, 512);
  EXPECT_TRUE(packed.planes.empty());
  Bake only_ao = random_bake(5, 5, 0);
  EXPECT_EQ(pack_planes(only_ao, 512).planes.size(), 1U);
}

TEST(HtmlPlanes, UnusableValuesAreNamed) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -0.5F}) {
    Bake bake = random_bake(6, 6, 2);
    bake.irradiance[1](4, 2) = bad;
    try {
      pack_planes(bake, 512);
      FAIL() << bad;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("irradiance.01 of texel 4,2 is "));
    }
  }
}

}  // namespace
}  // namespace hemibake
