#include "reference/lit_path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "core/statistics.h"
#include "reference/path_step.h"
#include "reference/random.h"
#include "reference/ray_caster.h"

namespace hemibake {
namespace {

constexpr double kLiftTexels = 1e-6;  // as RefereeOptions

void check_lighting(const Surface& surface, const RefereeLighting& lighting, int paths) {
  const Grid<glm::vec3>& albedo = lighting.albedo;
  const bool single = albedo.width == 1 && albedo.height == 1;
  if (!single && (albedo.width != surface.width() || albedo.height != surface.height()))
    throw InputError(fmt::format("albedo map of {}x{} texels, expected {}x{} as the heights, or 1x1",
                                 albedo.width, albedo.height, surface.width(), surface.height()));
  for (size_t i = 0; i < albedo.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (!(albedo[i][c] >= 0 && albedo[i][c] <= 1))
        throw InputError(fmt::format("albedo at texel {},{} is {}, expected 0..1",
                                     i % static_cast<size_t>(albedo.width),
                                     i / static_cast<size_t>(albedo.width), albedo[i][c]));
  if (paths < 2) throw InputError(fmt::format("referee paths {}, expected at least 2", paths));
}

// Interpolates the albedo at x, y in texels inside the map, up to one beyond the last texel of a wrapping
// one.
glm::dvec3 albedo_at(const Grid<glm::vec3>& albedo, Edge edge, double x, double y) {
  return interpolate_bilinear<double>(x, y, [&](int i, int j) {
    return glm::dvec3(albedo(wrap_or_clamp(i, albedo.width, edge), wrap_or_clamp(j, albedo.height, edge)));
  });
}

// Returns radiance times albedos along one path. Its mean over cosine-distributed paths is E/π.
glm::dvec3 path_light(const HeightFieldRayCaster& caster, const RefereeLighting& lighting, Edge edge,
                      SurfacePoint at, double lift, RefereeRandom& random) {
  glm::dvec3 share(1);
  for (;;) {
    const PathStep step = step_path(caster, at, lift, random);
    if (reaches_sky(step.outcome)) return share * lighting.sky(step.direction);
    at = step.hit;
    const glm::dvec3 albedo = albedo_at(lighting.albedo, edge, at.position.x, at.position.y);
    const double survival = std::max({albedo.r, albedo.g, albedo.b});
    if (survival == 0 || (survival < 1 && random.uniform() >= survival)) return glm::dvec3(0);
    share *= albedo / survival;
  }
}

}  // namespace

std::vector<RefereeIrradiance> referee_lit_texels(const Surface& surface, std::span<const uint32_t> texels,
                                                  const RefereeLighting& lighting, int paths, uint64_t seed) {
  check_lighting(surface, lighting, paths);
  const HeightFieldRayCaster caster(surface);
  const double lift = caster.start_lift(kLiftTexels);
  std::vector<RefereeIrradiance> results(texels.size());
  Progress progress("refereeing", texels.size(), "texel");
  parallel_for(texels.size(), 1, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const uint32_t texel = texels[i];
      const SurfacePoint receiver = texel_center(surface, texel);
      RefereeRandom random(seed, texel, 0);
      std::array<Moments, 3> moments;
      for (int p = 0; p < paths; ++p) {
        const glm::dvec3 light = path_light(caster, lighting, surface.edge, receiver, lift, random);
        for (int c = 0; c < 3; ++c) moments[static_cast<size_t>(c)].add(kPi * light[c]);
      }
      for (int c = 0; c < 3; ++c) {
        const Moments& channel = moments[static_cast<size_t>(c)];
        results[i].mean[c] = channel.mean;
        results[i].variance[c] = channel.sum_squared_deviations / (paths - 1.0) / paths;
      }
      progress.advance(1);
    }
  });
  return results;
}

}  // namespace hemibake
