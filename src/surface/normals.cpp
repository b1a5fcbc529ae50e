#include "surface/normals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/color.h"
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

// Deviation of a component below which a map is flat, and of a length from 1 that floats round away.
constexpr double kFlatDeviation = 1e-7, kFloatUnitLength = 1e-6;
// Smallest z that is made of x and y: codecs of two channels leave x² + y² a little above 1.
constexpr double kSmallestMadeZ = 1e-2;

double decoded_component(double stored, NormalEncoding encoding) {
  switch (encoding) {
    case NormalEncoding::kSigned:
      return stored;
    case NormalEncoding::kSrgb:
      return 2 * linear_from_srgb(stored) - 1;
    case NormalEncoding::kLinear:
      break;
  }
  return 2 * stored - 1;
}

// Returns the vector of a texel, of the length that is stored.
glm::dvec3 decoded_vector(const glm::vec3& stored, const NormalDecoding& decoding) {
  glm::dvec3 n;
  for (int c = 0; c < 3; ++c) {
    n[c] = decoded_component(static_cast<double>(stored[c]), decoding.encoding);
    if (decoding.negated[static_cast<size_t>(c)]) n[c] = -n[c];
  }
  if (decoding.y == NormalY::kUp) n.y = -n.y;
  if (!decoding.has_z) n.z = std::max(kSmallestMadeZ, std::sqrt(std::max(0.0, 1 - n.x * n.x - n.y * n.y)));
  return n;
}

// Returns the correlation of one component of two maps; none where either is flat.
std::optional<double> correlation(const Grid<glm::vec3>& a, const Grid<glm::vec3>& b, int component) {
  const auto count = static_cast<double>(a.size());
  double mean_a = 0, mean_b = 0, squares_a = 0, squares_b = 0, products = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    mean_a += static_cast<double>(a[i][component]) / count;
    mean_b += static_cast<double>(b[i][component]) / count;
  }
  for (size_t i = 0; i < a.size(); ++i) {
    const double of_a = static_cast<double>(a[i][component]) - mean_a;
    const double of_b = static_cast<double>(b[i][component]) - mean_b;
    squares_a += of_a * of_a / count;
    squares_b += of_b * of_b / count;
    products += of_a * of_b / count;
  }
  if (std::min(squares_a, squares_b) < kFlatDeviation * kFlatDeviation) return std::nullopt;
  return products / std::sqrt(squares_a * squares_b);
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
      // A cosine does not tell the angles of a needle.
      const double angle = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      sums(corners.texel[c].x % surface.width(), corners.texel[c].y % surface.height()) += angle * normal;
    }
  }
  Grid<glm::vec3> normals(surface.width(), surface.height());
  for (size_t i = 0; i < sums.size(); ++i) normals[i] = glm::vec3(glm::normalize(sums[i]));
  return normals;
}

Grid<glm::vec3> decode_normal_map(const Grid<glm::vec3>& encoded, const NormalDecoding& decoding) {
  Grid<glm::vec3> normals(encoded.width, encoded.height);
  for (size_t i = 0; i < encoded.size(); ++i) {
    const glm::dvec3 n = decoded_vector(encoded[i], decoding);
    const double length = glm::length(n);
    if (!std::isfinite(length) || length < 1e-3 || n.z <= 0)
      throw InputError(fmt::format(
          "normal at texel {},{} is ({}, {}, {}), expected a vector that points up ({})",
          i % static_cast<size_t>(encoded.width), i / static_cast<size_t>(encoded.width), n.x, n.y, n.z,
          decoding.encoding == NormalEncoding::kSigned ? "z above 0" : "blue above 0.5"));
    const bool is_unit =
        decoding.encoding == NormalEncoding::kSigned && std::abs(length - 1) < kFloatUnitLength;
    normals[i] = glm::vec3(is_unit ? n : n / length);
  }
  return normals;
}

Grid<float> normal_map_lengths(const Grid<glm::vec3>& encoded, const NormalDecoding& decoding) {
  Grid<float> lengths(encoded.width, encoded.height);
  for (size_t i = 0; i < encoded.size(); ++i)
    lengths[i] = static_cast<float>(glm::length(decoded_vector(encoded[i], decoding)));
  return lengths;
}

SlopeAgreement compare_slopes(const Grid<glm::vec3>& of_map, const Grid<glm::vec3>& of_heights) {
  SlopeAgreement agreement;
  agreement.x = correlation(of_map, of_heights, 0);
  agreement.y = correlation(of_map, of_heights, 1);
  double map_squares = 0, height_squares = 0;
  for (size_t i = 0; i < of_map.size(); ++i) {
    const glm::dvec3 m(of_map[i]), h(of_heights[i]);
    map_squares += h.z * h.z * (m.x * m.x + m.y * m.y);
    height_squares += m.z * m.z * (h.x * h.x + h.y * h.y);
  }
  if (height_squares > 0) agreement.slope_ratio = std::sqrt(map_squares / height_squares);
  return agreement;
}

}  // namespace hemibake
