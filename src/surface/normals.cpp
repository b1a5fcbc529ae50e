#include "surface/normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/error.h"
#include "surface/facets.h"

namespace hemibake {
namespace {

// Returns the slope of the heights along one axis. i: index of n. value(i): height, metres.
template <class Value>
double central_slope(int i, int n, Edge edge, double texel_size_m, const Value& value) {
  if (edge == Edge::kWrap)
    return (value(wrap_index(i + 1, n)) - value(wrap_index(i - 1, n))) / (2 * texel_size_m);
  const int low = std::max(0, i - 1), high = std::min(n - 1, i + 1);
  return high == low ? 0.0 : (value(high) - value(low)) / ((high - low) * texel_size_m);
}

}  // namespace

Grid<glm::vec3> central_difference_normals(const Surface& surface) {
  const auto& h = surface.heights_m;
  Grid<glm::vec3> normals(h.width, h.height);
  for (int y = 0; y < h.height; ++y) {
    for (int x = 0; x < h.width; ++x) {
      const double slope_x = central_slope(x, h.width, surface.edge, surface.texel_size_m,
                                           [&](int i) { return static_cast<double>(h(i, y)); });
      const double slope_y = central_slope(y, h.height, surface.edge, surface.texel_size_m,
                                           [&](int j) { return static_cast<double>(h(x, j)); });
      normals(x, y) = glm::vec3(glm::normalize(glm::dvec3(-slope_x, -slope_y, 1)));
    }
  }
  return normals;
}

Grid<glm::vec3> angle_weighted_normals(const Surface& surface) {
  Grid<glm::dvec3> sums(surface.width(), surface.height(), glm::dvec3(0));
  for (uint32_t facet = 0; facet < facet_count(surface); ++facet) {
    const auto corners = facet_corners(surface, facet);
    const auto p = facet_positions_texels(surface, facet);
    const glm::dvec3 normal = facet_normal(surface, facet);
    for (int c = 0; c < 3; ++c) {
      const glm::dvec3 a = glm::normalize(p[(c + 1) % 3] - p[c]);
      const glm::dvec3 b = glm::normalize(p[(c + 2) % 3] - p[c]);
      const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
      sums(corners.texel[c].x % surface.width(), corners.texel[c].y % surface.height()) += angle * normal;
    }
  }
  Grid<glm::vec3> normals(surface.width(), surface.height());
  for (size_t i = 0; i < sums.size(); ++i) normals[i] = glm::vec3(glm::normalize(sums[i]));
  return normals;
}

Grid<glm::vec3> decode_normal_map(const Grid<glm::vec3>& encoded, NormalY convention) {
  const double sign_y = convention == NormalY::kDown ? 1 : -1;
  Grid<glm::vec3> normals(encoded.width, encoded.height);
  for (size_t i = 0; i < encoded.size(); ++i) {
    const glm::dvec3 value(encoded[i]);
    const glm::dvec3 n(2 * value.x - 1, sign_y * (2 * value.y - 1), 2 * value.z - 1);
    const double length = glm::length(n);
    if (!std::isfinite(length) || length < 1e-3 || n.z <= 0)
      throw InputError(fmt::format(
          "normal at texel {},{} is ({}, {}, {}), expected a vector that points up (blue above 0.5)",
          i % static_cast<size_t>(encoded.width), i / static_cast<size_t>(encoded.width), n.x, n.y, n.z));
    normals[i] = glm::vec3(n / length);
  }
  return normals;
}

Grid<float> normal_map_lengths(const Grid<glm::vec3>& encoded) {
  Grid<float> lengths(encoded.width, encoded.height);
  for (size_t i = 0; i < encoded.size(); ++i)
    lengths[i] = static_cast<float>(glm::length(2.0 * glm::dvec3(encoded[i]) - 1.0));
  return lengths;
}

}  // namespace hemibake
