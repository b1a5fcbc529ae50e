#include "transport/albedo_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/error.h"

namespace hemibake {
namespace {

std::vector<double> as_double(const std::vector<float>& values) { return {values.begin(), values.end()}; }

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

void check_sizes(const Links& gather, const Links& patch_links, const DirectLight& direct,
                 std::span<const float> albedo) {
  expect_equal(patch_links.columns, patch_links.rows, "columns of the patch links");
  expect_equal(gather.columns, patch_links.rows, "columns of the gather links");
  expect_equal(direct.patches.size(), size_t{patch_links.rows}, "patches under direct light");
  expect_equal(direct.texels.size(), size_t{gather.rows}, "texels under direct light");
  expect_equal(albedo.size(), size_t{patch_links.rows}, "albedos");
  for (const float value : albedo)
    if (!(value >= 0 && value <= 1)) fail_expectation("an albedo", static_cast<double>(value), 1);
}

// out = links · (albedo · light)
void reflect(const Links& links, std::span<const float> albedo, const std::vector<double>& light,
             std::vector<double>& reflected, std::vector<double>& out) {
  for (size_t i = 0; i < light.size(); ++i) reflected[i] = static_cast<double>(albedo[i]) * light[i];
  gather(links, reflected, out);
}

}  // namespace

DirectLight uniform_sky(const Visibility& seen) {
  return {as_double(seen.direct_over_pi.values), as_double(seen.patch_direct())};
}

AlbedoLight bounce_with_albedo(const Links& gather, const Links& patch_links, const DirectLight& direct,
                               std::span<const float> albedo, const AlbedoOptions& options) {
  check_sizes(gather, patch_links, direct, albedo);
  const size_t patches = patch_links.rows;
  std::vector<double> light(patches, 1.0), next(patches), reflected(patches);
  // No row passes on more than `kept` of the largest light that reaches it, so that what follows a bounce of
  // at most c is at most c kept / (1 − kept).
  reflect(patch_links, albedo, light, reflected, next);
  const double kept = largest(next), unit = largest(direct.patches);
  const double followed_by = kept < 1 ? kept / (1 - kept) : std::numeric_limits<double>::infinity();

  AlbedoLight result;
  result.patches = direct.patches;
  result.products = 1;
  light = direct.patches;
  const auto missing = [&] {
    const double last = largest(light);
    return last > 0 ? last * followed_by / unit : 0;
  };
  // Texels gather the last bounce from the patches of the one before.
  const auto patch_bounces = options.bounces ? std::max(0, *options.bounces - 1) : options.max_products - 1;
  for (int b = 0; b < patch_bounces; ++b) {
    if (!options.bounces && missing() <= options.tolerance) break;
    reflect(patch_links, albedo, light, reflected, next);
    light.swap(next);
    for (size_t i = 0; i < patches; ++i) result.patches[i] += light[i];
    ++result.products;
  }
  result.missing = missing();
  result.texels = direct.texels;
  if (options.bounces == 0) return result;
  std::vector<double> gathered(result.texels.size());
  reflect(gather, albedo, result.patches, reflected, gathered);
  for (size_t i = 0; i < gathered.size(); ++i) result.texels[i] += gathered[i];
  return result;
}

AlbedoLight bounce_with_albedo(const Visibility& seen, std::span<const float> albedo,
                               const AlbedoOptions& options) {
  return bounce_with_albedo(seen.gather, seen.patch_links(), uniform_sky(seen), albedo, options);
}

}  // namespace hemibake
