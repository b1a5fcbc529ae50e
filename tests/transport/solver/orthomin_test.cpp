#include "transport/solver/orthomin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "support/maps.h"
#include "support/sliced.h"
#include "support/threads.h"
#include "transport/trace_surface.h"

namespace hemibake {
namespace {

std::vector<double> direct_of(const LightTransport& transport) {
  return {transport.patch_direct().begin(), transport.patch_direct().end()};
}

// E = direct + W diag(albedo) E by Gaussian elimination with pivots.
std::vector<double> solve_densely(const FormFactorMatrix& form_factors, const std::vector<float>& albedo,
                                  std::vector<double> right) {
  const size_t n = form_factors.rows;
  std::vector<std::vector<double>> matrix(n, std::vector<double>(n));
  for (size_t column = 0; column < n; ++column) {
    std::vector<double> one(n), product(n);
    one[column] = static_cast<double>(albedo[column]);
    multiply(form_factors, one, product);
    for (size_t row = 0; row < n; ++row) matrix[row][column] = (row == column) - product[row];
  }
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t row = k; row < n; ++row)
      if (std::abs(matrix[row][k]) > std::abs(matrix[pivot][k])) pivot = row;
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    for (size_t row = k + 1; row < n; ++row) {
      const double factor = matrix[row][k] / matrix[k][k];
      for (size_t column = k; column < n; ++column) matrix[row][column] -= factor * matrix[k][column];
      right[row] -= factor * right[k];
    }
  }
  for (size_t k = n; k-- > 0;) {
    for (size_t column = k + 1; column < n; ++column) right[k] -= matrix[k][column] * right[column];
    right[k] /= matrix[k][k];
  }
  return right;
}

// Products until no residual exceeds `tolerance`, light in `light`.
int solve(const LightTransport& transport, const std::vector<float>& albedo, double tolerance,
          std::vector<double>& light) {
  const std::vector<double> direct = direct_of(transport);
  Orthomin solver(transport.patch_form_factors, albedo, std::vector<double>(direct.size()), direct);
  int products = 0;
  while (solver.largest_residual() > tolerance && solver.step()) ++products;
  light = solver.light();
  return products;
}

TEST(Orthomin, AgreesWithEliminationAtAnyAlbedo) {
  const LightTransport transport = sliced(white_noise_surface(7, 5, 0.2));
  const size_t patches = transport.patch_form_factors.rows;
  for (const float albedo : {0.0f, 0.5f, 0.999999f, 1.0f, -1.0f}) {
    std::vector<float> albedos(patches, albedo);
    // Below 0: every patch another one.
    for (size_t i = 0; i < patches && albedo < 0; ++i) albedos[i] = static_cast<float>(i * 7 % 11) / 10;
    constexpr double kResidual = 1e-13;
    std::vector<double> light;
    solve(transport, albedos, kResidual, light);
    const std::vector<double> exact =
                                  solve_densely(transport.patch_form_factors, albedos, direct_of(transport)),
                              sums = solve_densely(transport.patch_form_factors, albedos,
                                                   std::vector<double>(patches, 1.0));
    // What is left of a residual adds up to that; products round what they multiply to nothing.
    const double tolerance = 2 * kResidual * *std::ranges::max_element(sums);
    for (size_t i = 0; i < patches; ++i) ASSERT_NEAR(light[i], exact[i], tolerance) << albedo;
  }
}

// Pairs that see each other and lose 2⁻⁶ … 2⁻¹² of their light to a node that sees the sky by half, and that
// sees one of each pair.
TEST(Orthomin, LightStaysInDeepPits) {
  constexpr uint32_t kPairs = 7;
  FormFactorMatrix form_factors = make_form_factors(2 * kPairs + 1, 2 * kPairs + 1);
  std::vector<FormFactor> sky;
  for (uint32_t pair = 0; pair < kPairs; ++pair) {
    const float lost = std::ldexp(1.0f, -6 - static_cast<int>(pair));
    append_row(form_factors.blocks[0], std::vector<FormFactor>{{2 * pair + 1, 1 - lost}, {2 * kPairs, lost}});
    append_row(form_factors.blocks[0], std::vector<FormFactor>{{2 * pair, 1.0f}});
    sky.push_back({2 * pair, 0.5f / 8});
  }
  append_row(form_factors.blocks[0], sky);
  finish_blocks(form_factors);
  // All in rows that add up to 1 with their sky, so that light is 1 everywhere.
  std::vector<double> direct = row_sums(form_factors);
  for (double& value : direct) value = 1 - value;
  Orthomin solver(form_factors, {}, std::vector<double>(direct.size()), direct);
  int products = 0;
  while (solver.largest_residual() > 1e-14 && solver.step()) ++products;
  EXPECT_LE(products, 8 + 2 * 3);  // eight before the groups; then all pairs are alike: two ways to go
  for (const double value : solver.light()) EXPECT_NEAR(value, 1, 1e-10);
}

// Deep pits at albedo 1, where the light is 1 everywhere in the end: neither made nor lost.
TEST(Orthomin, TakesAFractionOfTheBounces) {
  // Rows add up to 1 to the rounding of E₀ to float, 3·10⁻⁸, which a pit multiplies by the bounces it needs.
  constexpr double kTolerance = 1e-5;
  const LightTransport transport = sliced(white_noise_surface(20, 20, 0.5));
  const std::vector<double> direct = direct_of(transport);
  const auto furthest = [](const std::vector<double>& light) {
    double distance = 0;
    for (const double value : light) distance = std::max(distance, std::abs(1 - value));
    return distance;
  };
  Orthomin solver(transport.patch_form_factors, {}, std::vector<double>(direct.size()), direct);
  int products = 0, bounces = 0;
  while (furthest(solver.light()) > kTolerance && solver.step()) ++products;
  EXPECT_LE(furthest(solver.light()), kTolerance);
  std::vector<double> last = direct, sum = direct, next;
  for (; furthest(sum) > kTolerance && bounces < 5000; ++bounces) {
    apply_transport(transport.patch_form_factors, {}, last, next);
    last.swap(next);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += last[i];
  }
  EXPECT_LT(3 * products, bounces) << products;
}

TEST(Orthomin, EndsWhereNothingIsLeft) {
  const LightTransport transport = sliced(white_noise_surface(8, 8, 0.1));
  const size_t patches = transport.patch_form_factors.rows;
  Orthomin dark(transport.patch_form_factors, {}, std::vector<double>(patches), std::vector<double>(patches));
  EXPECT_FALSE(dark.step());
  EXPECT_EQ(dark.largest_residual(), 0);
}

TEST(Orthomin, SameBytesAtAnyThreadCount) {
  const LightTransport transport = sliced(white_noise_surface(48, 48, 0.1));
  std::vector<double> one, two;
  set_thread_count(1);
  solve(transport, {}, 1e-8, one);
  set_thread_count(2);
  solve(transport, {}, 1e-8, two);
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

}  // namespace
}  // namespace hemibake
