// A map refined ×1, ×2, ×4: what E₀, E₁ and the total at albedo ½ go to, with both kinds of patches, and how
// fast. Means over the original texels, which every refinement has among its own. Bilinear refinement
// converges to the surface that is bilinear between the texels, the smooth one (Catmull-Rom) to a surface
// without folds.
//
//   hemibake_bench_refine [SIDE] [RAYS]     (64, 128)
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "bench/bench_maps.h"
#include "core/constants.h"
#include "tracers/embree/embree.h"
#include "transport/bounces.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

// Weights of the four values around a point at fraction t between the middle two.
std::array<double, 4> weights_at(double t, bool smooth) {
  if (!smooth) return {0, 1 - t, t, 0};
  // Catmull, Rom, "A class of local interpolating splines", 1974.
  const double t2 = t * t, t3 = t2 * t;
  return {(-t3 + 2 * t2 - t) / 2, (3 * t3 - 5 * t2 + 2) / 2, (-3 * t3 + 4 * t2 + t) / 2, (t3 - t2) / 2};
}

Surface refine(const Surface& surface, int factor, bool smooth) {
  const int width = surface.width(), height = surface.height();
  Grid<float> heights(width * factor, height * factor);
  for (int y = 0; y < heights.height; ++y)
    for (int x = 0; x < heights.width; ++x) {
      const auto across = weights_at(static_cast<double>(x % factor) / factor, smooth),
                 down = weights_at(static_cast<double>(y % factor) / factor, smooth);
      double sum = 0;
      for (int j = 0; j < 4; ++j)
        for (int i = 0; i < 4; ++i)
          sum += across[static_cast<size_t>(i)] * down[static_cast<size_t>(j)] *
                 static_cast<double>(surface.heights_m(wrap_index(x / factor + i - 1, width),
                                                       wrap_index(y / factor + j - 1, height)));
      heights(x, y) = static_cast<float>(sum);
    }
  return make_surface(std::move(heights), surface.texel_size_m * std::max(width, height), 1, Edge::kWrap);
}

using Means = std::array<double, 3>;  // of E₀/π, E₁/π, total at albedo ½ over π

Means bake(const Surface& surface, int factor, PatchKind patches, int rays) {
  RayOptions options;
  options.rays = rays;
  options.patch_kind = patches;
  const auto tracer = make_embree_tracer(surface, options);
  const Bounces bounces = bounce_light(trace_surface(*tracer, KeptLinks::kAll), {10, std::nullopt, 10});
  Means means{};
  double count = 0;
  for (int y = 0; y < surface.height(); y += factor)
    for (int x = 0; x < surface.width(); x += factor, ++count) {
      double power = 1;
      for (size_t b = 0; b < bounces.irradiance.size(); ++b, power /= 2) {
        const double light = static_cast<double>(bounces.irradiance[b](x, y)) / kPi;
        if (b < 2) means[b] += light;
        means[2] += power * light;
      }
    }
  for (double& mean : means) mean /= count;
  return means;
}

void study(const BenchMap& map, bool smooth, PatchKind patches, int rays) {
  std::array<Means, 3> at;
  for (size_t i = 0; i < 3; ++i) {
    const int factor = 1 << i;
    at[i] = bake(refine(map.surface, factor, smooth), factor, patches, rays);
  }
  const char* names[] = {"E0/pi", "E1/pi", "total at 0.5"};
  for (size_t q = 0; q < 3; ++q) {
    const double first = at[0][q] - at[1][q], second = at[1][q] - at[2][q];
    // Where the second step is lost in noise there is no order to tell.
    const std::string order = first * second > 0 ? fmt::format("{:.1f}", std::log2(first / second)) : "-";
    fmt::print(
        "{:14} {:9} {:7} {:13} {:.5f} {:.5f} {:.5f}  order {:>4}  limit {:.5f}\n", map.name,
        smooth ? "smooth" : "bilinear", patches == PatchKind::kFacets ? "facets" : "texels", names[q],
        at[0][q], at[1][q], at[2][q], order,
        first * second > 0 && first / second > 1.2 ? at[2][q] - second / (first / second - 1) : at[2][q]);
  }
}

}  // namespace
}  // namespace hemibake

int main(int argc, char** argv) {
  using namespace hemibake;
  const int side = argc > 1 ? std::atoi(argv[1]) : 64, rays = argc > 2 ? std::atoi(argv[2]) : 128;
  std::vector<BenchMap> maps = bench_maps(side);
  maps.push_back({"noise 0.1 m", synthetic_surface(SyntheticKind::kNoise, side, side, 0.1)});
  for (const BenchMap& map : maps)
    for (const bool smooth : {false, true})
      for (const PatchKind patches : {PatchKind::kFacets, PatchKind::kTexels})
        study(map, smooth, patches, rays);
}
