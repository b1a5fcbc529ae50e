#include "estimators/disk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/statistics.h"
#include "estimators/disk_robust.h"
#include "estimators/horizon.h"
#include "support/maps.h"
#include "surface/facets.h"
#include "surface/synthetic/analytic.h"

namespace hemibake {
namespace {

Surface walls(SyntheticKind kind, int width, int height, double amplitude_texels, Edge edge) {
  return synthetic_surface(kind, width, height, amplitude_texels / std::max(width, height), {}, edge);
}

// Calls each(copy of disk j's position) for all copies within the radius of a wrapping map, horizontally.
template <class Each>
void for_each_copy(const Surface& surface, const glm::dvec3& receiver, const glm::dvec3& position,
                   double radius, const Each& each) {
  const int reach = surface.edge == Edge::kWrap ? 8 : 0;
  for (int ky = -reach; ky <= reach; ++ky)
    for (int kx = -reach; kx <= reach; ++kx) {
      const glm::dvec3 at = position + glm::dvec3(kx * surface.width(), ky * surface.height(), 0);
      if (std::hypot(at.x - receiver.x, at.y - receiver.y) <= radius) each(at);
    }
}

// The notes' formula, pass by pass, without tree or shared code.
std::vector<double> disk_by_brute_force(const Surface& surface, int passes, double radius_texels) {
  const std::vector<Disk> disks = vertex_disks(surface, VertexArea::kThirdOfEach);
  std::vector<double> last(disks.size(), 1), now(disks.size());
  for (int pass = 0; pass < passes; ++pass) {
    for (size_t i = 0; i < disks.size(); ++i) {
      const glm::dvec3 p = disks[i].position, n(surface.normals[i]);
      double shadow = 0;
      for (size_t j = 0; j < disks.size(); ++j) {
        for_each_copy(surface, p, disks[j].position, radius_texels, [&](const glm::dvec3& at) {
          const double d = glm::distance(at, p);
          if (d == 0) return;
          const glm::dvec3 v = (at - p) / d;
          const double cos_emitter = std::min(1.0, std::max(0.0, -glm::dot(disks[j].normal, v)));
          const double cos_receiver = std::min(1.0, std::max(0.0, 4 * glm::dot(n, v)));
          shadow += (1 - d / std::sqrt(disks[j].area_over_pi + d * d)) * cos_emitter * cos_receiver * last[j];
        });
      }
      now[i] = std::min(1.0, std::max(0.0, 1 - shadow));
    }
    last = now;
  }
  return last;
}

void expect_brute_force(const Surface& surface) {
  DiskOptions options;
  options.opening_ratio = 0;
  options.radius_m = 20 * surface.texel_size_m;
  for (const int passes : {1, 2, 3}) {
    options.passes = passes;
    const Estimate estimate = estimate_disk(surface, options);
    const std::vector<double> expected = disk_by_brute_force(surface, passes, 20);
    // Stored in float; sums in another order differ by far less.
    for (size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(estimate.ao[i], expected[i], 1e-7) << i;
  }
}

TEST(Disk, TreeWithRatioZeroIsThePapersSum) {
  expect_brute_force(white_noise_surface(12, 9, 0.3));
  expect_brute_force(white_noise_surface(12, 9, 0.3, Edge::kOpen));
  expect_brute_force(walls(SyntheticKind::kStep, 24, 8, 6, Edge::kOpen));
  expect_brute_force(walls(SyntheticKind::kCanyon, 24, 8, 6, Edge::kWrap));
}

TEST(Disk, VertexAreasAreAsChosen) {
  const Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8, 0.0, {}, Edge::kOpen);
  const auto thirds = vertex_disks(surface, VertexArea::kThirdOfEach);
  const auto averages = vertex_disks(surface, VertexArea::kAverage);
  const size_t inside = 3 * 8 + 4,
               corner = 0;  // six facets of half a texel each; one at the upper left corner
  EXPECT_NEAR(thirds[inside].area_over_pi * kPi, 1, 1e-12);
  EXPECT_NEAR(averages[inside].area_over_pi * kPi, 0.5, 1e-12);
  EXPECT_NEAR(thirds[corner].area_over_pi * kPi, 1.0 / 6, 1e-12);
  EXPECT_NEAR(averages[corner].area_over_pi * kPi, 0.5, 1e-12);
}

// Moved round, a map has the same AO, moved too: no seam.
template <class Estimator>
void expect_no_seam(const Estimator& estimate) {
  const Surface surface = white_noise_surface(10, 6, 0.2);
  Surface moved = surface;
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 10; ++x) {
      moved.heights_m((x + 4) % 10, (y + 3) % 6) = surface.heights_m(x, y);
      moved.normals((x + 4) % 10, (y + 3) % 6) = surface.normals(x, y);
    }
  const Estimate a = estimate(surface), b = estimate(moved);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 10; ++x) ASSERT_NEAR(a.ao(x, y), b.ao((x + 4) % 10, (y + 3) % 6), 1e-6);
}

TEST(Disk, HasNoSeam) {
  expect_no_seam([](const Surface& s) {
    DiskOptions options;
    options.opening_ratio = 0;
    options.radius_m = 2.01;  // no disk is just that far off
    return estimate_disk(s, options);
  });
  expect_no_seam([](const Surface& s) {
    DiskRobustOptions options;
    options.opening_ratio = 0;
    options.radius_m = 2.01;  // no disk is just that far off
    return estimate_disk_robust(s, options);
  });
}

// A wall of one texel's width has disks only at its foot and its edge, so the disk method does badly there;
// its error against the closed form is printed, and large.
TEST(Disk, ErrorOnWallAndCanyonIsStated) {
  constexpr double kHeight = 16;
  const Surface step = walls(SyntheticKind::kStep, 64, 128, kHeight, Edge::kOpen);
  const WallGeometry geometry = step_geometry(64);
  for (const int passes : {1, 3}) {
    DiskOptions disk;
    DiskRobustOptions robust;
    disk.passes = robust.passes = passes;
    const Estimate by_disk = estimate_disk(step, disk), by_robust = estimate_disk_robust(step, robust);
    for (const int distance : {2, 8, 24}) {
      const double a = std::atan(kHeight / distance);
      const int x = geometry.left_edge + distance;
      std::printf(
          "wall, passes %d, distance/height %.3f: alpha %.4f disk %+.4f | E0/pi %.4f disk-robust %+.4f\n",
          passes, distance / kHeight, 1 - a / kPi, static_cast<double>(by_disk.ao(x, 64)) - (1 - a / kPi),
          (1 + std::cos(a)) / 2, static_cast<double>(by_robust.ao(x, 64)) - (1 + std::cos(a)) / 2);
      EXPECT_GE(by_disk.ao(x, 64), 1 - a / kPi);  // sees too little of the wall
    }
  }
  const Surface canyon = walls(SyntheticKind::kCanyon, 64, 64, kHeight, Edge::kWrap);
  const WallGeometry between = canyon_geometry(64);
  const Estimate by_disk = estimate_disk(canyon, {}), by_robust = estimate_disk_robust(canyon, {});
  for (const int distance : {2, 8, 16}) {
    const int x = between.left_edge + distance;
    const double a = std::atan(kHeight / distance), b = std::atan(kHeight / (between.right_edge - x));
    const double alpha = 1 - (a + b) / kPi, cosine = (std::cos(a) + std::cos(b)) / 2;
    std::printf("canyon, distance/height %.3f: alpha %.4f disk %+.4f | E0/pi %.4f disk-robust %+.4f\n",
                distance / kHeight, alpha, static_cast<double>(by_disk.ao(x, 32)) - alpha, cosine,
                static_cast<double>(by_robust.ao(x, 32)) - cosine);
  }
}

// With a groove the facets are small against the walls, and the disks do what they were made for. Measured
// +0.124 and −0.044.
TEST(Disk, ErrorOnGrooveIsStated) {
  const Surface surface = synthetic_surface(SyntheticKind::kGroove, 64, 64, {}, kPi / 4);
  const Estimate estimate = estimate_disk(surface, {}), robust = estimate_disk_robust(surface, {});
  const GrooveGeometry groove = groove_geometry(64, kPi / 4);
  double disk_sum = 0, robust_sum = 0;
  for (int i = 1; i < groove.wall_width; ++i) {
    const double s = i / std::sin(kPi / 4), l = groove.wall_width / std::sin(kPi / 4);
    const double f = -s / std::hypot(l, s);
    disk_sum += static_cast<double>(estimate.ao(i, 32)) - std::acos(f) / kPi;
    robust_sum += static_cast<double>(robust.ao(i, 32)) - (1 - f) / 2;
  }
  std::printf("groove wall mean: disk %+.4f, disk-robust %+.4f\n", disk_sum / (groove.wall_width - 1),
              robust_sum / (groove.wall_width - 1));
  EXPECT_NEAR(disk_sum / (groove.wall_width - 1), 0, 0.15);
  EXPECT_NEAR(robust_sum / (groove.wall_width - 1), 0, 0.1);
}

// One pass with polygons and no tree on a wall that hides nothing behind it: its exact form factor, whatever
// the number of triangles it is cut into.
TEST(DiskRobust, LoneWallIsExact) {
  constexpr double kHeight = 12;
  constexpr int kLong = 96;
  const Surface surface = walls(SyntheticKind::kStep, 24, kLong, kHeight, Edge::kOpen);
  DiskRobustOptions options;
  options.passes = 1;
  options.opening_ratio = 0;
  const Estimate estimate = estimate_disk_robust(surface, options);
  const int foot = step_geometry(24).left_edge + 1, row = kLong / 2;
  for (const int distance : {1, 3, 8}) {
    const int x = foot + distance;
    // The whole wall as one quadrilateral: foot at x = foot, upper edge a texel to the left.
    const std::array<glm::dvec3, 4> wall{{{-distance, -row, 0},
                                          {-distance, kLong - 1 - row, 0},
                                          {-distance - 1, kLong - 1 - row, kHeight},
                                          {-distance - 1, -row, kHeight}}};
    const double exact = 1 - std::abs(polygon_form_factor(wall, {0, 0, 1}));
    // The lift of 10⁻³ texel lowers the wall by as much: at most 10⁻³ / distance / 2.
    EXPECT_NEAR(estimate.ao(x, row), exact, 5e-4 / distance + 1e-6);
    // A wall without end: what is missing beyond its ends, each (H/L)² or so, is below 10⁻².
    EXPECT_NEAR(estimate.ao(x, row), (1 + std::cos(std::atan(kHeight / (distance + 1)))) / 2, 1e-2);
  }
}

TEST(DiskRobust, TreeWithRatioZeroIsThePapersSum) {
  for (const Edge edge : {Edge::kWrap, Edge::kOpen}) {
    const Surface surface = white_noise_surface(8, 7, 0.3, edge);
    const double radius = 14.05;  // no disk is just that far off
    DiskRobustOptions options;
    options.passes = 2;
    options.opening_ratio = 0;
    options.radius_m = radius * surface.texel_size_m;
    options.robust = false;
    options.distance_attenuation_per_m = 3;
    options.triangle_attenuation = 0.5;
    const Estimate estimate = estimate_disk_robust(surface, options);

    const std::vector<Disk> disks = facet_disks(surface);
    const auto accessibility = [&](const glm::dvec3& p, const glm::dvec3& n,
                                   const std::vector<double>& weights) {
      double shadow = 0;
      for (size_t j = 0; j < disks.size(); ++j)
        for_each_copy(surface, p, disks[j].position, radius, [&](const glm::dvec3& at) {
          const double d2 = glm::dot(at - p, at - p);
          if (d2 == 0) return;
          const glm::dvec3 v = (at - p) / std::sqrt(d2);
          const double cosines = std::max(0.0, -glm::dot(disks[j].normal, v)) * std::max(0.0, glm::dot(n, v));
          shadow += disks[j].area_over_pi / (disks[j].area_over_pi + d2) * cosines * weights[j] /
                    (1 + 3 * std::sqrt(d2) * surface.texel_size_m);
        });
      return std::min(1.0, std::max(0.0, 1 - shadow));
    };
    std::vector<double> weights(disks.size());
    const std::vector<double> ones(disks.size(), 1);
    for (size_t i = 0; i < disks.size(); ++i)
      weights[i] = std::sqrt(accessibility(disks[i].position, disks[i].normal, ones));
    for (int y = 0; y < 7; ++y)
      for (int x = 0; x < 8; ++x) {
        const glm::dvec3 p(x, y, surface.heights_m(x, y) / surface.texel_size_m + 1e-3);
        ASSERT_NEAR(estimate.ao(x, y), accessibility(p, glm::dvec3(surface.normals(x, y)), weights), 1e-7);
      }
  }
}

TEST(DiskRobust, AttenuationTakesShadowAway) {
  const Surface surface = white_noise_surface(24, 24, 0.2);
  DiskRobustOptions options;
  const auto mean_ao = [&] { return mean(estimate_disk_robust(surface, options).ao.values); };
  const double plain = mean_ao();
  options.distance_attenuation_per_m = 5;
  EXPECT_GT(mean_ao(), plain);
  options.distance_attenuation_per_m = 0;
  options.triangle_attenuation = 3;
  EXPECT_GT(mean_ao(), plain);
  options.triangle_attenuation = 0;
  EXPECT_LT(mean_ao(), plain);
}

// On a groove's wall the opposite wall hides the low sky: what is left lies nearer the vertical than the
// normal.
TEST(Disk, BentNormalsTurnTowardsTheSky) {
  const Surface surface = synthetic_surface(SyntheticKind::kGroove, 64, 16, {}, kPi / 4);
  const GrooveGeometry groove = groove_geometry(64, kPi / 4);
  const Estimate disk = estimate_disk(surface, {}), robust = estimate_disk_robust(surface, {});
  for (int x = 2; x < groove.wall_width - 1; ++x) {
    for (const Estimate* estimate : {&disk, &robust}) {
      EXPECT_GT(estimate->bent_normals(x, 8).z, surface.normals(x, 8).z) << x;
      EXPECT_NEAR(estimate->bent_normals(x, 8).y, 0, 0.05) << x;
    }
  }
}

// The claim of the paper: smoothness without the artefacts of disks. The texel-to-texel part of the error
// (root mean square of its discrete Laplacian) against a converged horizon walk, on smooth relief with
// creases of a few texels.
TEST(DiskRobust, IsSmootherThanDisks) {
  constexpr int kSize = 48;
  const Surface surface = synthetic_surface(SyntheticKind::kNoise, kSize, kSize);
  HorizonOptions converged;
  converged.azimuths = 64;
  converged.steps = 200;
  converged.jitter = false;
  const auto roughness = [&](const Estimate& estimate) {
    converged.kind = estimate.kind;
    const Estimate truth = estimate_horizon(surface, converged);
    const auto error = [&](int x, int y) {
      const int i = wrap_index(x, kSize), j = wrap_index(y, kSize);
      return static_cast<double>(estimate.ao(i, j)) - static_cast<double>(truth.ao(i, j));
    };
    Moments squares;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const double laplacian =
            4 * error(x, y) - error(x - 1, y) - error(x + 1, y) - error(x, y - 1) - error(x, y + 1);
        squares.add(laplacian * laplacian);
      }
    return std::sqrt(squares.mean);
  };
  DiskRobustOptions without_polygons;
  without_polygons.robust = false;
  const double disk = roughness(estimate_disk(surface, {}));
  const double facets = roughness(estimate_disk_robust(surface, without_polygons));
  const double polygons = roughness(estimate_disk_robust(surface, {}));
  std::printf("roughness of the error: disk %.4f, facet disks %.4f, with polygons %.4f\n", disk, facets,
              polygons);
  EXPECT_LT(polygons, 0.5 * facets);
  EXPECT_LT(polygons, 0.3 * disk);
}

TEST(DiskLight, FlatGroundSendsNothing) {
  const Surface surface = synthetic_surface(SyntheticKind::kFlat, 8, 8);
  const Grid<float> direct(8, 8, static_cast<float>(kPi));
  const auto light = disk_light(surface, direct, {}, {.bounces = 2});
  ASSERT_EQ(light.size(), 3u);
  for (const float value : light[1].values) EXPECT_EQ(value, 0);
}

// Bounce 1 without shadow passes is Σ F E_0 over the fronts; a shadow pass can only take from it.
TEST(DiskLight, IsThePapersTransfer) {
  const Surface surface = white_noise_surface(9, 8, 0.2, Edge::kOpen);
  const std::vector<Disk> disks = vertex_disks(surface, VertexArea::kThirdOfEach);
  Grid<float> direct(9, 8);
  for (size_t i = 0; i < direct.size(); ++i)
    direct[i] = static_cast<float>(kPi * unit_interval(mix_bits(1, 1, i)));
  DiskOptions options;
  options.opening_ratio = 0;
  const auto open = disk_light(surface, direct, options, {.bounces = 1, .shadow_passes = 0});
  const auto shadowed = disk_light(surface, direct, options, {.bounces = 1, .shadow_passes = 1});
  for (size_t i = 0; i < disks.size(); ++i) {
    double sum = 0;
    for (size_t j = 0; j < disks.size(); ++j) {
      if (i == j) continue;
      const glm::dvec3 v = disks[j].position - disks[i].position;
      const double d = glm::length(v), area = kPi * disks[j].area_over_pi;
      sum += area * std::max(0.0, -glm::dot(disks[j].normal, v) / d) *
             std::max(0.0, glm::dot(glm::dvec3(surface.normals[i]), v) / d) / (kPi * d * d + area) *
             static_cast<double>(direct[j]);
    }
    ASSERT_NEAR(open[1][i], sum, 1e-6 * (1 + sum));
    ASSERT_LE(shadowed[1][i], open[1][i]);
  }
}

// Wall means of a tiled 45° groove at ρ = 1 (tests/analytic/groove_reference.h). E_0 is given exactly; the
// far walls that the tiling hides send too much without a shadow pass, so the error is printed for both.
TEST(DiskLight, GrooveBouncesComeNearTheClosedForm) {
  const Surface surface = synthetic_surface(SyntheticKind::kGroove, 64, 64, {}, kPi / 4);
  const GrooveGeometry groove = groove_geometry(64, kPi / 4);
  Grid<float> direct(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const int along = x % groove.period;
      const double s = std::min(along, groove.period - along), l = groove.wall_width;
      direct(x, y) = static_cast<float>(kPi * (1 + s / std::hypot(l, s)) / 2);
    }
  const double expected[] = {0.7071068, 0.1963495, 0.0629587};
  for (const int shadow_passes : {0, 1}) {
    const auto light = disk_light(surface, direct, {}, {.bounces = 2, .shadow_passes = shadow_passes});
    for (size_t bounce = 0; bounce < 3; ++bounce)
      std::printf("groove, shadow passes %d: E%zu/pi %.4f, closed form %.4f\n", shadow_passes, bounce,
                  mean(light[bounce].values) / kPi, expected[bounce]);
    if (shadow_passes == 1) {
      EXPECT_NEAR(mean(light[1].values) / kPi, expected[1], 0.05);
    }
  }
}

}  // namespace
}  // namespace hemibake
