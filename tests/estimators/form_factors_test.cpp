#include "estimators/form_factors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

using Triangle = std::array<glm::dvec3, 3>;

const glm::dvec3 kUp(0, 0, 1);

// Gauss-Legendre, 5 points, on [0, 1]: exact to degree 9.
constexpr std::array<double, 5> kNodes{0.04691007703066800, 0.23076534494715846, 0.5, 0.76923465505284154,
                                       0.95308992296933200};
constexpr std::array<double, 5> kWeights{0.11846344252809454, 0.23931433524968324, 0.28444444444444444,
                                         0.23931433524968324, 0.11846344252809454};

double integrate(double begin, double end, int panels, const std::function<double(double)>& f) {
  double sum = 0;
  const double width = (end - begin) / panels;
  for (int p = 0; p < panels; ++p)
    for (size_t i = 0; i < kNodes.size(); ++i)
      sum += kWeights[i] * width * f(begin + (p + kNodes[i]) * width);
  return sum;
}

// ∫ cosθ_R cosθ_E / (π d²) over the part of the triangle above the receiver's plane: rows of the triangle,
// each cut where it meets the plane. Signed as polygon_form_factor is.
double form_factor_by_quadrature(const Triangle& t, const glm::dvec3& normal) {
  const glm::dvec3 area_normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const auto row = [&](double u) {
    const glm::dvec3 left = t[0] + u * (t[1] - t[0]), right = t[0] + u * (t[2] - t[0]);
    const double a = glm::dot(normal, left), b = glm::dot(normal, right);
    double begin = 0, end = 1;
    if (a <= 0 && b <= 0) return 0.0;
    if (a < 0) begin = a / (a - b);
    if (b < 0) end = a / (a - b);
    return u * integrate(begin, end, 24, [&](double v) {
             const glm::dvec3 q = left + v * (right - left);
             const double d2 = glm::dot(q, q);
             return glm::dot(normal, q) * glm::dot(area_normal, -q) / (kPi * d2 * d2);
           });
  };
  // Kinks where a corner crosses the plane: cut the rows' range there.
  std::vector<double> cuts{0, 1};
  for (const int corner : {1, 2}) {
    const double a = glm::dot(normal, t[0]), b = glm::dot(normal, t[corner]);
    if ((a > 0) != (b > 0)) cuts.push_back(a / (a - b));
  }
  std::sort(cuts.begin(), cuts.end());
  double sum = 0;
  for (size_t i = 0; i + 1 < cuts.size(); ++i) sum += integrate(cuts[i], cuts[i + 1], 24, row);
  return sum;
}

double exact_form_factor(const Triangle& triangle, const glm::dvec3& normal) {
  return polygon_form_factor(clip_to_horizon(triangle, normal).corners(), normal);
}

glm::dvec3 random_point(uint64_t seed, double size) {
  glm::dvec3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = size * (2 * unit_interval(mix_bits(seed, static_cast<uint64_t>(axis), 11)) - 1);
  return p;
}

// On the axis of a parallel disk both formulas are exact: its uniform share is 1 − d/√(r² + d²), its form
// factor r²/(r² + d²).
TEST(DiskFormulas, AreThePapersAndExactOnTheAxis) {
  for (const double d : {1e-3, 0.5, 1.0, 7.0, 1e4}) {
    for (const double radius : {0.1, 1.0, 30.0}) {
      const glm::dvec3 to_disk(0, 0, d);
      EXPECT_DOUBLE_EQ(disk_form_factor(to_disk, -kUp, radius * radius, kUp, OccluderSide::kFront),
                       radius * radius / (radius * radius + d * d));
      // The difference from 1 cancels for a small disk.
      EXPECT_NEAR(disk_shadow(to_disk, -kUp, radius * radius, kUp, OccluderSide::kFront),
                  1 - d / std::sqrt(radius * radius + d * d), 4e-16);
    }
  }
}

TEST(DiskFormulas, ClampBothCosines) {
  const glm::dvec3 to_disk(3, 0, 0.5);
  const double d2 = 9.25, d = std::sqrt(d2), area_over_pi = 0.4;
  const glm::dvec3 facing = glm::normalize(glm::dvec3(-1, 0.3, 0.2));
  const double cos_emitter = (3 - 0.1) / std::sqrt(1.13) / d, cos_receiver = 0.5 / d;
  EXPECT_NEAR(disk_shadow(to_disk, facing, area_over_pi, kUp, OccluderSide::kFront),
              (1 - d / std::sqrt(area_over_pi + d2)) * cos_emitter * 4 * cos_receiver, 1e-16);
  EXPECT_NEAR(disk_form_factor(to_disk, facing, area_over_pi, kUp, OccluderSide::kFront),
              area_over_pi / (area_over_pi + d2) * cos_emitter * cos_receiver, 1e-16);
  EXPECT_EQ(disk_shadow(to_disk, facing, area_over_pi, kUp, OccluderSide::kBack), 0);
  EXPECT_EQ(disk_shadow(to_disk, -facing, area_over_pi, kUp, OccluderSide::kFront), 0);
  EXPECT_GT(disk_shadow(to_disk, -facing, area_over_pi, kUp, OccluderSide::kBack), 0);
  EXPECT_EQ(disk_form_factor(to_disk, facing, area_over_pi, -kUp, OccluderSide::kFront), 0);
  // Beyond cos θ_R = 1/4 the receiver's factor is 1.
  EXPECT_NEAR(disk_shadow({3, 0, 3}, facing, area_over_pi, kUp, OccluderSide::kFront),
              (1 - std::sqrt(18 / (area_over_pi + 18))) * ((1 - 0.2) / std::sqrt(1.13) / std::sqrt(2)),
              1e-16);
}

// The farther a triangle, the better its disk: printed, and within the ratio of size to distance squared.
TEST(DiskFormulas, FarTriangleIsADisk) {
  const glm::dvec3 center = glm::normalize(glm::dvec3(1, 0.4, 0.8));
  for (const double d : {1.0, 2.0, 5.0, 20.0, 100.0}) {
    Triangle t{{{0.5, -0.3, -0.3}, {-0.2, -0.3, 0.6}, {-0.3, 0.6, -0.3}}};
    glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double area = 0.5 * glm::length(normal);
    normal = glm::normalize(normal);
    const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    for (glm::dvec3& corner : t) corner += d * center - middle;
    const OccluderSide side = glm::dot(normal, center) < 0 ? OccluderSide::kFront : OccluderSide::kBack;
    const double exact = std::abs(exact_form_factor(t, kUp));
    const double disk = disk_form_factor(d * center, normal, area / kPi, kUp, side);
    std::printf("triangle of radius %.2f at %5.1f: exact %.3e, disk %+.2f %%\n", std::sqrt(area / kPi), d,
                exact, 100 * (disk / exact - 1));
    // Second moments of a triangle over d²; the disk itself gives up A/π over d².
    EXPECT_NEAR(disk / exact, 1, 0.8 / (d * d)) << d;
  }
}

TEST(Polygon, AgreesWithQuadrature) {
  int clipped = 0, compared = 0;
  double worst = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    Triangle t;
    for (uint64_t i = 0; i < 3; ++i) t[i] = random_point(3 * seed + i, 2);
    const glm::dvec3 normal = glm::normalize(random_point(seed + 10000, 1));
    // The quadrature needs a smooth integrand: keep the plane of the triangle half a unit away from the
    // receiver.
    const glm::dvec3 plane = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
    if (std::abs(glm::dot(plane, t[0])) < 0.5) continue;
    const double exact = exact_form_factor(t, normal);
    const double quadrature = form_factor_by_quadrature(t, normal);
    const int above =
        (glm::dot(normal, t[0]) > 0) + (glm::dot(normal, t[1]) > 0) + (glm::dot(normal, t[2]) > 0);
    clipped += above == 1 || above == 2;
    ++compared;
    worst = std::max(worst, std::abs(exact - quadrature));
    ASSERT_NEAR(exact, quadrature, 1e-6) << "seed " << seed << ", corners above " << above;
  }
  std::printf("%d triangles, %d of them clipped: worst difference %.1e\n", compared, clipped, worst);
  EXPECT_GT(clipped, 50);
}

TEST(Polygon, ClipKeepsWhatIsAbove) {
  EXPECT_EQ(clip_to_horizon({{{0, 0, 1}, {1, 0, 1}, {0, 1, 2}}}, kUp).count, 3);
  EXPECT_EQ(clip_to_horizon({{{0, 0, 1}, {1, 0, -1}, {0, 1, -1}}}, kUp).count, 3);
  EXPECT_EQ(clip_to_horizon({{{0, 0, 1}, {1, 0, 1}, {0, 1, -1}}}, kUp).count, 4);
  EXPECT_EQ(clip_to_horizon({{{0, 0, 0}, {1, 0, -1}, {0, 1, -1}}}, kUp).count, 0);
  const ClippedTriangle cut = clip_to_horizon({{{0, 0, 3}, {4, 0, -1}, {0, 4, -1}}}, kUp);
  EXPECT_EQ(cut.corner[1], glm::dvec3(3, 0, 0));
  EXPECT_EQ(cut.corner[2], glm::dvec3(0, 3, 0));
}

// A closed surface is entered as often as it is left: its form factors add up to nothing; and a huge triangle
// overhead is all there is.
TEST(Polygon, SumsOverClosedSurfaces) {
  const std::array<glm::dvec3, 4> p{{{1, 1, 0.2}, {3, 1, -0.5}, {1.5, 2.5, 0.4}, {2, 1.6, 2.5}}};
  double sum = 0;
  for (const auto& [a, b, c] : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
    sum += exact_form_factor(
        {p[static_cast<size_t>(a)], p[static_cast<size_t>(b)], p[static_cast<size_t>(c)]}, kUp);
  EXPECT_NEAR(sum, 0, 1e-15);
  EXPECT_NEAR(exact_form_factor({{{-1e9, -1e9, 1}, {0, 2e9, 1}, {2e9, -1e9, 1}}}, kUp), 1, 1e-8);
}

}  // namespace
}  // namespace hemibake
