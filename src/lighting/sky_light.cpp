#include "lighting/sky_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "reference/ray_caster.h"
#include "sampling/low_discrepancy.h"
#include "sampling/warp.h"
#include "surface/facets.h"
#include "surface/frame.h"
#include "tracers/ray_options.h"

namespace hemibake {
namespace {

constexpr size_t kGrain = 256;
constexpr double kLiftTexels = 1e-6;  // as the referee's: the walk cannot leak, rounding has to be cleared
constexpr int kSunGrid = 4;           // points a side from which a receiver looks at the sun
// Streams of mix_bits.
constexpr uint64_t kTexelStream = 0x736b7954, kPatchStream = 0x736b7950;

// Texel x, y is the corner of a cell; on an open map the last ones are the far ends of theirs.
struct GroundPoint {
  double x, y;
};

// The point of the surface over x, y, texels, wrapped or moved into an open map.
SurfacePoint surface_over(const Surface& surface, const HeightFieldRayCaster& walk, GroundPoint at) {
  const auto columns = static_cast<int>(facet_columns(surface));
  const auto rows = static_cast<int>(facet_count(surface) / 2) / columns;
  const auto into = [&](double value, int cells, int& cell) {
    if (surface.edge == Edge::kOpen) value = std::clamp(value, 0.0, static_cast<double>(cells));
    const double floor = std::floor(value);
    cell = static_cast<int>(floor);
    if (surface.edge == Edge::kOpen) cell = std::min(cell, cells - 1);
    const double share = value - cell;
    cell = wrap_index(cell, cells);
    return share;
  };
  int i = 0, j = 0;
  const double u = into(at.x, columns, i), v = into(at.y, rows, j);
  const auto cell = static_cast<uint32_t>(j) * static_cast<uint32_t>(columns) + static_cast<uint32_t>(i);
  if (u + v <= 1) return walk.point_on_facet(2 * cell, u, v);
  return walk.point_on_facet(2 * cell + 1, 1 - u, 1 - v);
}

bool sees(const HeightFieldRayCaster& walk, const SurfacePoint& from, double lift,
          const glm::dvec3& direction) {
  SurfacePoint hit;
  return walk.follow(from.position + glm::dvec3(0, 0, lift), direction, hit) != RayOutcome::kHit;
}

// ∫ (L − mean) V max(0, n·ω) dω + mean · E₀, with as many rays as `rays_of(receiver)` says and starts and
// normals that `start(receiver, u)` gives.
template <class Rays, class Start>
std::vector<glm::dvec3> sky_light(const HeightFieldRayCaster& walk, std::span<const float> direct_over_pi,
                                  const Radiance& radiance, const SkyLightOptions& options, uint64_t stream,
                                  const Rays& rays_of, const Start& start) {
  std::vector<glm::dvec3> light(direct_over_pi.size());
  const double lift = walk.start_lift(kLiftTexels);
  Progress progress("tracing the sky", light.size(), "receiver");
  parallel_for(light.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t receiver = begin; receiver < end; ++receiver) {
      const auto rays = static_cast<uint32_t>(rays_of(receiver));
      double shift[4];
      for (uint64_t k = 0; k < 4; ++k)
        shift[k] = unit_interval(mix_bits(options.seed, stream, 4 * receiver + k));
      glm::dvec3 sum(0);
      for (uint32_t ray = 0; ray < rays; ++ray) {
        const glm::dvec2 u = {cranley_patterson_rotate((ray + 0.5) / rays, shift[0]),
                              cranley_patterson_rotate(radical_inverse(2, ray), shift[1])};
        const glm::dvec2 place = {cranley_patterson_rotate(radical_inverse(3, ray), shift[2]),
                                  cranley_patterson_rotate(radical_inverse(5, ray), shift[3])};
        const SurfacePoint from = start(receiver, place);
        const glm::dvec3 direction = frame_about(from.normal).world_from_tangent(sample_cosine_hemisphere(u));
        if (sees(walk, from, lift, direction)) sum += radiance(direction) - options.mean_radiance;
      }
      light[receiver] = kPi * (sum / static_cast<double>(rays) +
                               static_cast<double>(direct_over_pi[receiver]) * options.mean_radiance);
    }
    progress.advance(end - begin);
  });
  return light;
}

SurfacePoint texel_center(const Surface& surface, size_t texel) {
  return {texel_position_texels(surface, static_cast<uint32_t>(texel)), glm::dvec3(surface.normals[texel])};
}

// One of the points that a patch looks from; u in the unit square.
SurfacePoint patch_start(const HeightFieldRayCaster& walk, const PatchSet& patches, size_t patch,
                         const glm::dvec2& u) {
  const FacetNode node = facet_node(patches, static_cast<uint32_t>(patch));
  const glm::dvec2 at = node_start_uv(node.node, sample_uniform_triangle(u));
  return walk.point_on_facet(node.facet, at.x, at.y);
}

// Shares of kSunGrid² points, in the middle of equal parts of the unit square.
template <class SeenFrom>
double share_of_points(const SeenFrom& seen_from) {
  int seen = 0;
  for (int a = 0; a < kSunGrid; ++a)
    for (int b = 0; b < kSunGrid; ++b)
      seen += seen_from(glm::dvec2((a + 0.5) / kSunGrid, (b + 0.5) / kSunGrid));
  return static_cast<double>(seen) / (kSunGrid * kSunGrid);
}

template <class Share>
std::vector<double> shares(size_t receivers, const Share& share) {
  std::vector<double> result(receivers);
  parallel_for(receivers, kGrain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) result[i] = share(i);
  });
  return result;
}

}  // namespace

std::vector<glm::dvec3> sky_light_of_texels(const Surface& surface, std::span<const float> direct_over_pi,
                                            const Radiance& radiance, const SkyLightOptions& options) {
  expect_equal(direct_over_pi.size(), size_t{surface.texel_count()}, "texels given to sky_light_of_texels");
  const HeightFieldRayCaster walk(surface);
  return sky_light(
      walk, direct_over_pi, radiance, options, kTexelStream, [&](size_t) { return options.rays; },
      [&](size_t texel, const glm::dvec2&) { return texel_center(surface, texel); });
}

std::vector<glm::dvec3> sky_light_of_patches(const Surface& surface, const PatchSet& patches,
                                             std::span<const float> direct_over_pi, const Radiance& radiance,
                                             const SkyLightOptions& options) {
  expect_equal(direct_over_pi.size(), size_t{patches.count}, "patches given to sky_light_of_patches");
  const HeightFieldRayCaster walk(surface);
  const auto rays_of = [&](size_t patch) {
    const FacetNode node = facet_node(patches, static_cast<uint32_t>(patch));
    return rays_per_node(options.rays, node.subdivision, node.node);
  };
  return sky_light(walk, direct_over_pi, radiance, options, kPatchStream, rays_of,
                   [&](size_t patch, const glm::dvec2& u) { return patch_start(walk, patches, patch, u); });
}

std::vector<double> sun_share_of_texels(const Surface& surface, const glm::dvec3& direction) {
  const HeightFieldRayCaster walk(surface);
  const double lift = walk.start_lift(kLiftTexels);
  return shares(surface.texel_count(), [&](size_t texel) {
    const SurfacePoint center = texel_center(surface, texel);
    const double cosine = glm::dot(center.normal, direction);
    if (cosine <= 0) return 0.0;
    return cosine * share_of_points([&](const glm::dvec2& u) {
             const GroundPoint at = {center.position.x + u.x - 0.5, center.position.y + u.y - 0.5};
             return sees(walk, surface_over(surface, walk, at), lift, direction);
           });
  });
}

std::vector<double> sun_share_of_patches(const Surface& surface, const PatchSet& patches,
                                         const glm::dvec3& direction) {
  const HeightFieldRayCaster walk(surface);
  const double lift = walk.start_lift(kLiftTexels);
  return shares(patches.count, [&](size_t patch) {
    const glm::dvec3 normal = patch_start(walk, patches, patch, {}).normal;
    const double cosine = glm::dot(normal, direction);
    if (cosine <= 0) return 0.0;
    return cosine * share_of_points([&](const glm::dvec2& u) {
             return sees(walk, patch_start(walk, patches, patch, u), lift, direction);
           });
  });
}

}  // namespace hemibake
