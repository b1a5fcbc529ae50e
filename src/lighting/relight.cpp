#include "lighting/relight.h"

#include <algorithm>
#include <glm/common.hpp>

#include "core/constants.h"
#include "core/error.h"
#include "core/statistics.h"
#include "transport/series.h"

namespace hemibake {
namespace {

// Sums the bounces and their tail. albedo: the largest of the surface, per channel. most: bound of the total.
void add_up(Relit& relit, const glm::vec3& albedo, double most) {
  const size_t count = relit.bounces.size();
  const Grid<glm::vec3>& first = relit.bounces[0];
  relit.total = Grid<glm::vec3>(first.width, first.height);
  Moments rests;
  for (size_t i = 0; i < first.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      double sum = 0;
      for (const Grid<glm::vec3>& bounce : relit.bounces) sum += static_cast<double>(bounce[i][c]);
      double rest = 0;
      if (count >= 3)
        rest = series_tail(static_cast<double>(relit.bounces[count - 2][i][c]),
                           static_cast<double>(relit.bounces[count - 1][i][c]),
                           static_cast<double>(albedo[c]), most - sum);
      relit.total[i][c] = static_cast<float>(sum + rest);
      rests.add(rest);
      relit.largest_rest = std::max(relit.largest_rest, rest);
    }
  relit.mean_rest = rests.mean;
}

std::vector<double> channel(const std::vector<glm::dvec3>& light, int c) {
  std::vector<double> values(light.size());
  for (size_t i = 0; i < light.size(); ++i) values[i] = light[i][c];
  return values;
}

void store_channel(const std::vector<double>& values, int c, Grid<glm::vec3>& grid) {
  for (size_t i = 0; i < values.size(); ++i) grid[i][c] = static_cast<float>(values[i]);
}

}  // namespace

Relit relight_constant(const std::vector<Grid<float>>& irradiance, const glm::vec3& albedo) {
  Relit relit;
  glm::dvec3 power(1);
  for (const Grid<float>& at_albedo_1 : irradiance) {
    Grid<glm::vec3> bounce(at_albedo_1.width, at_albedo_1.height);
    for (size_t i = 0; i < bounce.size(); ++i)
      bounce[i] = glm::vec3(power * static_cast<double>(at_albedo_1[i]));
    relit.bounces.push_back(std::move(bounce));
    power *= glm::dvec3(albedo);
  }
  add_up(relit, albedo, kPi);
  return relit;
}

Relit relight_by_transport(const LightTransport& transport, const ColoredLight& direct,
                           const std::vector<glm::vec3>& patch_albedo, int bounces, double most) {
  expect_equal(direct.texel_light.size(), transport.direct_over_pi.size(), "direct light of texels");
  expect_equal(direct.patch_light.size(), size_t{transport.final_gather.columns}, "direct light of patches");
  expect_equal(patch_albedo.size(), direct.patch_light.size(), "albedo of patches");
  const int width = transport.direct_over_pi.width, height = transport.direct_over_pi.height;
  Relit relit;
  relit.bounces.assign(static_cast<size_t>(bounces) + 1, Grid<glm::vec3>(width, height));
  for (int c = 0; c < 3; ++c) {
    store_channel(channel(direct.texel_light, c), c, relit.bounces[0]);
    std::vector<double> light = channel(direct.patch_light, c), next(light.size());
    std::vector<double> at_texels(direct.texel_light.size());
    for (int b = 1; b <= bounces; ++b) {
      for (size_t j = 0; j < light.size(); ++j) light[j] *= static_cast<double>(patch_albedo[j][c]);
      multiply(transport.final_gather, light, at_texels);
      store_channel(at_texels, c, relit.bounces[static_cast<size_t>(b)]);
      if (b == bounces) break;
      multiply(transport.bounce_matrix(), light, next);
      light.swap(next);
    }
  }
  glm::vec3 largest(0);
  for (const glm::vec3& albedo : patch_albedo) largest = glm::max(largest, albedo);
  add_up(relit, largest, most);
  return relit;
}

}  // namespace hemibake
