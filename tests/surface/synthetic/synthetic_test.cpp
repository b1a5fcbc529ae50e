#include "surface/synthetic/synthetic.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <string>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "support/threads.h"
#include "surface/surface.h"
#include "tracers/embree/embree.h"
#include "transport/trace_surface.h"

namespace hemibake {

void PrintTo(const SyntheticKindInfo& kind, std::ostream* stream) { *stream << kind.name; }

namespace {

class SyntheticKinds : public testing::TestWithParam<SyntheticKindInfo> {};

SyntheticOptions size(int width, int height, uint64_t seed = 1) {
  return {.width = width, .height = height, .seed = seed, .angle_rad = {}};
}

// Mean and largest step from column x to column x + 1 (wrapped), over all rows.
struct Jump {
  double mean = 0, largest = 0;
};
Jump jump_after_column(const Grid<float>& map, int x) {
  Jump jump;
  for (int y = 0; y < map.height; ++y) {
    const double step = std::abs(double{map(wrap_index(x + 1, map.width), y)} - map(x, y));
    jump.mean += step / map.height;
    jump.largest = std::max(jump.largest, step);
  }
  return jump;
}

Grid<float> transposed(const Grid<float>& map) {
  Grid<float> turned(map.height, map.width);
  for (int y = 0; y < map.height; ++y)
    for (int x = 0; x < map.width; ++x) turned(y, x) = map(x, y);
  return turned;
}

// The step across the border, from the last column to the first, is like one of the steps inside.
void expect_no_seam(const Grid<float>& map, const std::string& what) {
  Jump worst_inside;
  for (int x = 0; x + 1 < map.width; ++x) {
    const Jump jump = jump_after_column(map, x);
    worst_inside.mean = std::max(worst_inside.mean, jump.mean);
    worst_inside.largest = std::max(worst_inside.largest, jump.largest);
  }
  const Jump seam = jump_after_column(map, map.width - 1);
  // The mean of 50 or more steps of random ground scatters by about a tenth.
  EXPECT_LE(seam.mean, 1.25 * worst_inside.mean) << what;
  EXPECT_LE(seam.largest, worst_inside.largest) << what;
}

TEST_P(SyntheticKinds, SameBytesAtAnyThreadCount) {
  set_thread_count(1);
  const SyntheticMap once = synthesize(GetParam().kind, size(70, 90));
  set_thread_count(2);
  const SyntheticMap again = synthesize(GetParam().kind, size(70, 90));
  set_thread_count(0);
  EXPECT_EQ(once.heights.values, again.heights.values);
}

TEST_P(SyntheticKinds, ContinuesWhereItRepeats) {
  for (const auto& [width, height] : {std::pair{128, 128}, {192, 80}, {50, 120}}) {
    const Grid<float> map = synthesize(GetParam().kind, size(width, height)).heights;
    const std::string what = std::to_string(width) + "x" + std::to_string(height);
    expect_no_seam(map, what + " left to right");
    expect_no_seam(transposed(map), what + " top to bottom");
  }
}

TEST_P(SyntheticKinds, HeightsFillZeroToOne) {
  for (const auto& [width, height] : {std::pair{64, 64}, {100, 30}, {30, 100}, {33, 47}}) {
    const Grid<float> map = synthesize(GetParam().kind, size(width, height)).heights;
    EXPECT_EQ(std::ranges::min(map.values), 0);
    EXPECT_EQ(std::ranges::max(map.values), GetParam().kind == SyntheticKind::kFlat ? 0 : 1);
  }
}

TEST_P(SyntheticKinds, WorksAtExtremeSizes) {
  for (const auto& [width, height] :
       {std::pair{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 3}, {1, 257}, {257, 1}, {3, 500}, {499, 2}}) {
    const SyntheticMap map = synthesize(GetParam().kind, size(width, height));
    EXPECT_EQ(map.heights.width, width);
    EXPECT_EQ(map.heights.height, height);
    EXPECT_TRUE(std::isfinite(map.recommended_amplitude_m) && map.recommended_amplitude_m >= 0);
    for (const float value : map.heights.values)
      ASSERT_TRUE(value >= 0 && value <= 1) << width << "x" << height << ": " << value;
  }
}

TEST_P(SyntheticKinds, MakesASurfaceAtTheRecommendedAmplitude) {
  const SyntheticMap map = synthesize(GetParam().kind, size(64, 48));
  const Surface surface = make_surface(map.heights, 1, map.recommended_amplitude_m, Edge::kWrap);
  const double range = GetParam().kind == SyntheticKind::kFlat ? 0 : map.recommended_amplitude_m;
  EXPECT_NEAR(height_range_m(surface), range, 1e-7 * range);
}

TEST_P(SyntheticKinds, AngleIsTakenOnlyWhereItMeansSomething) {
  SyntheticOptions options = size(16, 16);
  options.angle_rad = 0.5;
  if (GetParam().default_angle_deg) {
    EXPECT_NO_THROW(synthesize(GetParam().kind, options));
    for (const double degrees : {0.0, 0.5, 89.5, 90.0, -45.0, std::nan("")}) {
      options.angle_rad = degrees * kPi / 180;
      EXPECT_THROW(synthesize(GetParam().kind, options), InputError) << degrees;
    }
  } else {
    EXPECT_THROW(synthesize(GetParam().kind, options), InputError);
  }
}

INSTANTIATE_TEST_SUITE_P(All, SyntheticKinds,
                         testing::ValuesIn(synthetic_kinds().begin(), synthetic_kinds().end()),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST(Synthetic, TableIsInTheOrderOfTheEnumeration) {
  for (size_t i = 0; i < synthetic_kinds().size(); ++i)
    EXPECT_EQ(static_cast<size_t>(synthetic_kinds()[i].kind), i) << synthetic_kinds()[i].name;
}

// The materials come first in the table, then the shapes that are the same for every seed.
TEST(Synthetic, SeedsChangeMaterialsOnly) {
  for (const SyntheticKindInfo& info : synthetic_kinds()) {
    const Grid<float> one = synthesize(info.kind, size(64, 64, 1)).heights;
    const Grid<float> other = synthesize(info.kind, size(64, 64, 2)).heights;
    EXPECT_EQ(one.values != other.values, info.kind < SyntheticKind::kFlat) << info.name;
  }
}

// Mean absolute steps along x and along y, per unit of the longer side.
struct Slopes {
  double along_x = 0, along_y = 0;
};
Slopes mean_slopes(const Grid<float>& map) {
  Slopes slopes;
  const double per_step =
      static_cast<double>(std::max(map.width, map.height)) / static_cast<double>(map.size());
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      slopes.along_x += per_step * std::abs(double{map(wrap_index(x + 1, map.width), y)} - map(x, y));
      slopes.along_y += per_step * std::abs(double{map(x, wrap_index(y + 1, map.height))} - map(x, y));
    }
  }
  return slopes;
}

// Features keep their shape on a map half as high: its steps are like those of the square map in either
// direction. Stretched features would double those along y. Two random samples of ground differ by as much as
// a third.
TEST(Synthetic, MaterialsKeepTheirShapeOnMapsThatAreNotSquare) {
  for (const SyntheticKindInfo& info : synthetic_kinds().first(static_cast<size_t>(SyntheticKind::kFlat))) {
    const Slopes square = mean_slopes(synthesize(info.kind, size(256, 256)).heights);
    const Slopes wide = mean_slopes(synthesize(info.kind, size(256, 128)).heights);
    EXPECT_NEAR(wide.along_x / square.along_x, 1, 0.35) << info.name;
    EXPECT_NEAR(wide.along_y / square.along_y, 1, 0.35) << info.name;
  }
}

TEST(Synthetic, RefusesSizesOutOfRange) {
  for (const auto& [width, height] : {std::pair{0, 5}, {5, 0}, {-3, 5}, {1 << 20, 1 << 20}})
    EXPECT_THROW(synthesize(SyntheticKind::kFlat, size(width, height)), InputError);
}

// A brick wall is only a test of AO curves if it has light of every amount.
TEST(Synthetic, BricksFillEveryBinOfAmbientOcclusion) {
  const SyntheticMap map = synthesize(SyntheticKind::kBricks, size(512, 512));
  const Surface surface = make_surface(map.heights, 1, map.recommended_amplitude_m, Edge::kWrap);
  const auto tracer = make_embree_tracer(surface, {.rays = 128});
  const LightTransport seen = trace_surface(*tracer, KeptLinks::kNone);
  int counts[100] = {};
  for (const float alpha : seen.visible_fraction.values)
    ++counts[std::min(99, static_cast<int>(100 * alpha))];
  for (int bin = 0; bin < 100; ++bin) EXPECT_GE(counts[bin], 3) << "bin " << bin;
}

}  // namespace
}  // namespace hemibake
