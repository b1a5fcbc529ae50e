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

void check_sizes(const FormFactorMatrix& final_gather, const FormFactorMatrix& patch_links,
                 const DirectLight& direct, std::span<const float> albedo) {
  expect_equal(patch_links.columns, patch_links.rows, "columns of the patch links");
  expect_equal(final_gather.columns, patch_links.rows, "columns of the gather links");
  expect_equal(direct.patch_light.size(), size_t{patch_links.rows}, "patches under direct light");
  expect_equal(direct.texel_light.size(), size_t{final_gather.rows}, "texels under direct light");
  expect_equal(albedo.size(), size_t{patch_links.rows}, "albedos");
  for (const float value : albedo)
    if (!(value >= 0 && value <= 1)) fail_expectation("an albedo", static_cast<double>(value), 1);
}

// A bound of how much light a source of 1 in every patch can add up to: of the largest row sum of
// (I − W diag(albedo))⁻¹, which has no negative entry. What no row passes on more of than `kept` adds up to
// at most 1/(1 − kept); where that says little, the sum itself is sought until its residual is at most ½
// everywhere: the truth is then at most twice as much.
double largest_sum(const FormFactorMatrix& links, std::span<const float> albedo, double kept,
                   int max_products, int& products) {
  constexpr double kSaysEnough = 10, kResidual = 0.5;
  if (kept < 1 && 1 / (1 - kept) <= kSaysEnough) return 1 / (1 - kept);
  const std::vector<double> ones(links.rows, 1.0);
  Orthomin solver(links, albedo, std::vector<double>(links.rows), ones);
  while (solver.largest_residual() > kResidual) {
    if (products >= max_products || !solver.step())
      return kept < 1 ? 1 / (1 - kept) : std::numeric_limits<double>::infinity();
    ++products;
  }
  return largest(solver.light()) / kResidual;
}

// Light of the patches after `bounces` bounces; `last` is the last of them by itself.
void bounce(const FormFactorMatrix& links, std::span<const float> albedo, int bounces,
            std::vector<double>& light, std::vector<double>& last) {
  std::vector<double> next;
  for (int b = 0; b < bounces; ++b) {
    apply_transport(links, albedo, last, next);
    last.swap(next);
    for (size_t i = 0; i < light.size(); ++i) light[i] += last[i];
  }
}

}  // namespace

DirectLight uniform_sky(const LightTransport& seen) {
  return {as_double(seen.direct_over_pi.values), as_double(seen.patch_direct())};
}

AlbedoLight bounce_with_albedo(const FormFactorMatrix& final_gather, const FormFactorMatrix& patch_links,
                               const DirectLight& direct, std::span<const float> albedo,
                               const AlbedoOptions& options) {
  check_sizes(final_gather, patch_links, direct, albedo);
  AlbedoLight result;
  result.patch_light = direct.patch_light;
  result.texel_light = direct.texel_light;
  const double unit = largest(direct.patch_light);
  if (options.bounces == 0 || unit == 0) return result;
  std::vector<double> last = direct.patch_light;
  if (options.bounces) {
    // Texels gather their last bounce from the patches of the one before.
    bounce(patch_links, albedo, *options.bounces - 1, result.patch_light, last);
    result.products = *options.bounces - 1;
  } else {
    std::vector<double> passed_on;
    apply_transport(patch_links, albedo, std::vector<double>(patch_links.rows, 1.0), passed_on);
    apply_transport(patch_links, albedo, direct.patch_light, last);
    result.products = 2;
    const double sum =
        largest_sum(patch_links, albedo, largest(passed_on), options.max_products, result.products);
    Orthomin solver(patch_links, albedo, std::move(result.patch_light), std::move(last));
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

AlbedoLight bounce_with_albedo(const LightTransport& seen, std::span<const float> albedo,
                               const AlbedoOptions& options) {
  return bounce_with_albedo(seen.final_gather, seen.bounce_matrix(), uniform_sky(seen), albedo, options);
}

}  // namespace hemibake
