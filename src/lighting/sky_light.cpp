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
constexpr double kLiftTexels = 1e-6;  // as RefereeOptions: clears rounding
constexpr int kSunGrid = 4;           // shadow rays a side of a receiver
// Streams of mix_bits.
constexpr uint64_t kTexelStream = 0x736b7954, kPatchStream = 0x736b7950;

struct GroundPoint {
  double x, y;  // texels
};

// Returns the point of the surface over x, y, wrapped or clamped into an open map.
SurfacePoint surface_over(const Surface& surface, const HeightFieldRayCaster& caster, GroundPoint at) {
  const auto columns = static_cast<int>(facet_columns(surface));
  const auto rows = static_cast<int>(facet_count(surface) / 2) / columns;
  const auto into = [&](double value, int cells, int& cell) {
    if (surface.edge != Edge::kWrap) value = std::clamp(value, 0.0, static_cast<double>(cells));
    const double floor = std::floor(value);
    cell = static_cast<int>(floor);
    if (surface.edge != Edge::kWrap) cell = std::min(cell, cells - 1);
    const double share = value - cell;
    cell = wrap_index(cell, cells);
    return share;
  };
  int i = 0, j = 0;
  const double u = into(at.x, columns, i), v = into(at.y, rows, j);
  const auto cell = static_cast<uint32_t>(j) * static_cast<uint32_t>(columns) + static_cast<uint32_t>(i);
  if (u + v <= 1) return caster.point_on_facet(2 * cell, u, v);
  return caster.point_on_facet(2 * cell + 1, 1 - u, 1 - v);
}

// Returns whether the sky is visible in a direction.
bool sky_visible(const HeightFieldRayCaster& caster, const SurfacePoint& from, double lift,
                 const glm::dvec3& direction) {
  SurfacePoint hit;
  return reaches_sky(caster.cast(from.position + glm::dvec3(0, 0, lift), direction, hit));
}

template <class Rays, class Start>
struct Receivers {
  uint64_t stream;  // of mix_bits
  Rays rays_of;     // rays_of(receiver): number of rays
  Start start;      // start(receiver, u): point and normal where a ray begins, u in the unit square
};
// Clang 14 does not deduce the arguments of an aggregate by itself.
template <class Rays, class Start>
Receivers(uint64_t, Rays, Start) -> Receivers<Rays, Start>;

// Returns ∫ (L − mean) V max(0, n·ω) dω + mean · E₀ of every receiver.
template <class Rays, class Start>
std::vector<glm::dvec3> sky_light(const HeightFieldRayCaster& caster, const Receivers<Rays, Start>& receivers,
                                  std::span<const float> direct_over_pi, const Radiance& radiance,
                                  const SkyLightOptions& options) {
  std::vector<glm::dvec3> light(direct_over_pi.size());
  const double lift = caster.start_lift(kLiftTexels);
  Progress progress("tracing the sky", light.size(), "receiver");
  parallel_for(light.size(), kGrain, [&](size_t begin, size_t end) {
    for (size_t receiver = begin; receiver < end; ++receiver) {
      const auto rays = static_cast<uint32_t>(receivers.rays_of(receiver));
      double shift[4];
      for (uint64_t k = 0; k < 4; ++k)
        shift[k] = unit_interval(mix_bits(options.seed, receivers.stream, 4 * receiver + k));
      glm::dvec3 sum(0);
      for (uint32_t ray = 0; ray < rays; ++ray) {
        const glm::dvec2 u = {cranley_patterson_rotate((ray + 0.5) / rays, shift[0]),
                              cranley_patterson_rotate(radical_inverse(2, ray), shift[1])};
        const glm::dvec2 place = {cranley_patterson_rotate(radical_inverse(3, ray), shift[2]),
                                  cranley_patterson_rotate(radical_inverse(5, ray), shift[3])};
        const SurfacePoint from = receivers.start(receiver, place);
        const glm::dvec3 direction = frame_about(from.normal).world_from_tangent(sample_cosine_hemisphere(u));
        if (sky_visible(caster, from, lift, direction)) sum += radiance(direction) - options.mean_radiance;
      }
      light[receiver] = kPi * (sum / static_cast<double>(rays) +
                               static_cast<double>(direct_over_pi[receiver]) * options.mean_radiance);
    }
    progress.advance(end - begin);
  });
  return light;
}

// Returns a point where a patch receives light. u: in the unit square.
SurfacePoint patch_start(const HeightFieldRayCaster& caster, const PatchSet& patches, size_t patch,
                         const glm::dvec2& u) {
  const FacetNode node = facet_node(patches, static_cast<uint32_t>(patch));
  const glm::dvec2 at = node_start_uv(node.node, sample_uniform_triangle(u));
  return caster.point_on_facet(node.facet, at.x, at.y);
}

// Returns the share of kSunGrid² points, in the middle of equal parts of the unit square, that see the sun.
template <class SeesSun>
double share_of_points(const SeesSun& sees_sun) {
  int seen = 0;
  for (int a = 0; a < kSunGrid; ++a)
    for (int b = 0; b < kSunGrid; ++b)
      seen += sees_sun(glm::dvec2((a + 0.5) / kSunGrid, (b + 0.5) / kSunGrid));
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
  const HeightFieldRayCaster caster(surface);
  const Receivers texels{kTexelStream, [&](size_t) { return options.rays; },
                         [&](size_t texel, const glm::dvec2&) { return texel_center(surface, texel); }};
  return sky_light(caster, texels, direct_over_pi, radiance, options);
}

std::vector<glm::dvec3> sky_light_of_patches(const Surface& surface, const PatchSet& patches,
                                             std::span<const float> direct_over_pi, const Radiance& radiance,
                                             const SkyLightOptions& options) {
  expect_equal(direct_over_pi.size(), size_t{patches.count}, "patches given to sky_light_of_patches");
  const HeightFieldRayCaster caster(surface);
  const auto rays_of = [&](size_t patch) {
    const FacetNode node = facet_node(patches, static_cast<uint32_t>(patch));
    return rays_per_node(options.rays, node.subdivision, node.node);
  };
  const Receivers nodes{kPatchStream, rays_of, [&](size_t patch, const glm::dvec2& u) {
                          return patch_start(caster, patches, patch, u);
                        }};
  return sky_light(caster, nodes, direct_over_pi, radiance, options);
}

std::vector<double> sun_share_of_texels(const Surface& surface, const glm::dvec3& direction) {
  const HeightFieldRayCaster caster(surface);
  const double lift = caster.start_lift(kLiftTexels);
  return shares(surface.texel_count(), [&](size_t texel) {
    const SurfacePoint center = texel_center(surface, texel);
    const double cosine = glm::dot(center.normal, direction);
    if (cosine <= 0) return 0.0;
    return cosine * share_of_points([&](const glm::dvec2& u) {
             const GroundPoint at = {center.position.x + u.x - 0.5, center.position.y + u.y - 0.5};
             return sky_visible(caster, surface_over(surface, caster, at), lift, direction);
           });
  });
}

std::vector<double> sun_share_of_patches(const Surface& surface, const PatchSet& patches,
                                         const glm::dvec3& direction) {
  const HeightFieldRayCaster caster(surface);
  const double lift = caster.start_lift(kLiftTexels);
  return shares(patches.count, [&](size_t patch) {
    const glm::dvec3 normal = patch_start(caster, patches, patch, {}).normal;
    const double cosine = glm::dot(normal, direction);
    if (cosine <= 0) return 0.0;
    return cosine * share_of_points([&](const glm::dvec2& u) {
             return sky_visible(caster, patch_start(caster, patches, patch, u), lift, direction);
           });
  });
}

}  // namespace hemibake
