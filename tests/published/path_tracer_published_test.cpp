// Tests the reference path tracer on WallHeight at 0.1 m against an independent one (33 million paths on the
// same triangles).
#include <gtest/gtest.h>

#include <filesystem>
#include <numeric>

#include "io/image_io.h"
#include "reference/path_tracer.h"
#include "reference/texel_sample.h"
#include "surface/normals.h"

namespace hemibake {
namespace {

constexpr double kRounding = 0.5e-4;  // four digits, from 33 million paths (5·10⁻⁵ standard error in E₁)

void expect_means(const Surface& surface, double direct, double first_bounce, double total_at_half) {
  std::vector<uint32_t> texels(surface.texel_count());
  std::iota(texels.begin(), texels.end(), 0u);
  RefereeOptions options;
  options.paths = 128;
  options.bounces = 1;
  const TexelSample sample = sample_texels(texels, 30'000, 1);
  const RefereeEstimates measured = referee_texels(surface, sample.texels, options);
  const double truth[] = {direct, first_bounce, total_at_half};
  for (int q = 0; q < 3; ++q) {
    std::vector<double> values, variances;
    for (size_t i = 0; i < sample.texels.size(); ++i) {
      values.push_back(measured.mean[measured.index(i, q)]);
      variances.push_back(measured.variance[measured.index(i, q)]);
    }
    const RefereeInterval interval = mean_from_sample(sample, values, variances, 0.99);
    EXPECT_NEAR(interval.mean, truth[q], interval.half_width + 3 * kRounding) << "quantity " << q;
    EXPECT_LT(interval.half_width, 0.015 * interval.mean) << "quantity " << q;
  }
}

TEST(PathTracerPublished, AgreesWithAnIndependentPathTracerOnWallHeight) {
  const std::filesystem::path path = std::filesystem::path(HEMIBAKE_REFERENCE_DIR) / "WallHeight.png";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  Surface surface = make_surface(read_height_map(path), 1, 0.1, Edge::kWrap);
  expect_means(surface, 0.2556, 0.1266, 0.3550);  // about central differences
  surface.normals = angle_weighted_normals(surface);
  expect_means(surface, 0.3202, 0.1126, 0.4089);
}

}  // namespace
}  // namespace hemibake
