#include "transport/albedo_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/error.h"
#include "transport/solver/orthomin.h"

namespace hemibake {
namespace {

std::vector<double> as_double(const std::vector<float>& values) { return {values.begin(), values.end()}; }

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

void check_sizes(const FormFactorMatrix& final_gather, const FormFactorMatrix& patch_form_factors,
                 const DirectLight& direct, std::span<const float> albedo) {
  expect_equal(patch_form_factors.columns, patch_form_factors.rows, "columns of the patch form factors");
  expect_equal(final_gather.columns, patch_form_factors.rows, "columns of the final gather");
  expect_equal(direct.patch_light.size(), size_t{patch_form_factors.rows}, "patches under direct light");
  expect_equal(direct.texel_light.size(), size_t{final_gather.rows}, "texels under direct light");
  expect_equal(albedo.size(), size_t{patch_form_factors.rows}, "albedos");
  for (const float value : albedo)
    if (!(value >= 0 && value <= 1)) fail_expectation("an albedo", static_cast<double>(value), 1);
}

// Bounds the largest row sum of (I − W diag(albedo))⁻¹, which has no negative entry: the light of a source of
// 1 in every patch. It is at most 1/(1 − kept); if that is large, solves for the row sums until the residual
// is at most ½ everywhere, when they are at least half of the truth. kept: largest share of light that a row
// passes on. products: counts those made.
double largest_sum(const FormFactorMatrix& form_factors, std::span<const float> albedo, double kept,
                   int max_products, int& products) {
  constexpr double kSaysEnough = 10, kResidual = 0.5;
  if (kept < 1 && 1 / (1 - kept) <= kSaysEnough) return 1 / (1 - kept);
  const std::vector<double> ones(form_factors.rows, 1.0);
  Orthomin solver(form_factors, albedo, std::vector<double>(form_factors.rows), ones);
  while (solver.largest_residual() > kResidual) {
    if (products >= max_products || !solver.step())
      return kept < 1 ? 1 / (1 - kept) : std::numeric_limits<double>::infinity();
    ++products;
  }
  return largest(solver.light()) / kResidual;
}

// Adds `bounces` bounces to the light of the patches. last: the last bounce by itself, on entry and on
// return.
void bounce(const FormFactorMatrix& form_factors, std::span<const float> albedo, int bounces,
            std::vector<double>& light, std::vector<double>& last) {
  std::vector<double> next;
  for (int b = 0; b < bounces; ++b) {
    apply_transport(form_factors, albedo, last, next);
    last.swap(next);
    for (size_t i = 0; i < light.size(); ++i) light[i] += last[i];
  }
}

}  // namespace

DirectLight uniform_sky(const LightTransport& transport) {
  return {as_double(transport.direct_over_pi.values), as_double(transport.patch_direct())};
}

AlbedoLight bounce_with_albedo(const FormFactorMatrix& final_gather,
                               const FormFactorMatrix& patch_form_factors, const DirectLight& direct,
                               std::span<const float> albedo, const AlbedoOptions& options) {
  check_sizes(final_gather, patch_form_factors, direct, albedo);
  AlbedoLight result;
  result.patch_light = direct.patch_light;
  result.texel_light = direct.texel_light;
  const double unit = largest(direct.patch_light);
  if (options.bounces == 0 || unit == 0) return result;
  std::vector<double> last = direct.patch_light;
  if (options.bounces) {
    // Texels gather their last bounce from the patches of the one before.
    bounce(patch_form_factors, albedo, *options.bounces - 1, result.patch_light, last);
    result.products = *options.bounces - 1;
  } else {
    std::vector<double> passed_on;
    apply_transport(patch_form_factors, albedo, std::vector<double>(patch_form_factors.rows, 1.0), passed_on);
    apply_transport(patch_form_factors, albedo, direct.patch_light, last);
    result.products = 2;
    const double sum =
        largest_sum(patch_form_factors, albedo, largest(passed_on), options.max_products, result.products);
    Orthomin solver(patch_form_factors, albedo, std::move(result.patch_light), std::move(last));
    const auto missing = [&] {
      const double residual = solver.largest_residual();
      return residual > 0 ? residual * sum / unit : 0;
    };
    while (missing() > options.tolerance && result.products < options.max_products && solver.step())
      ++result.products;
    result.missing = missing();
    result.patch_light = solver.light();
  }
  std::vector<double> gathered;
  apply_transport(final_gather, albedo, result.patch_light, gathered);
  for (size_t i = 0; i < gathered.size(); ++i) result.texel_light[i] += gathered[i];
  return result;
}

AlbedoLight bounce_with_albedo(const LightTransport& transport, std::span<const float> albedo,
                               const AlbedoOptions& options) {
  return bounce_with_albedo(transport.final_gather, transport.bounce_matrix(), uniform_sky(transport), albedo,
                            options);
}

}  // namespace hemibake
