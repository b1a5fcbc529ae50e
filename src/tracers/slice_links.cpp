#include "tracers/slice_links.h"

#include <algorithm>
#include <cmath>

#include "surface/facets.h"
#include "tracers/link_merge.h"

namespace hemibake {
namespace {

// Texels: a stretch longer than this is split where patches are texels.
constexpr double kLongestPiece = 0.25;

// A stretch in its slice: the line z = gradient · r − depth from the start, where r is the horizontal
// distance.
struct StretchLine {
  double gradient;
  double depth;      // ≥ 0: how far the facet's plane passes below the start
  double near, far;  // ends of the stretch

  StretchLine(const Surface& surface, const Stretch& stretch, glm::dvec2 direction) {
    const glm::dvec3 normal = facet_normal(surface, stretch.facet);
    gradient = -(normal.x * direction.x + normal.y * direction.y) / normal.z;
    far = 1 / static_cast<double>(stretch.inverse_distance);
    depth = std::max(0.0, (gradient - static_cast<double>(stretch.high)) * far);
    near = std::min(far, distance_at(static_cast<double>(stretch.low)));
  }
  double distance_at(double slope) const { return slope < gradient ? depth / (gradient - slope) : far; }
  double slope_at(double distance) const { return gradient - depth / distance; }
  double ray_length(double distance) const { return std::hypot(distance, gradient * distance - depth); }
};

}  // namespace

SliceStretchSums sums_between(double low_slope, double high_slope) {
  const double low = std::atan(low_slope), high = std::atan(high_slope);
  const double sin_low = std::sin(low), sin_high = std::sin(high);
  return {sin_high - sin_low, (high - low) / 2 + (std::sin(2 * high) - std::sin(2 * low)) / 4,
          (sin_high * sin_high - sin_low * sin_low) / 2};
}

double stretch_distance(const Surface& surface, const Stretch& stretch, glm::dvec2 direction, double slope) {
  return StretchLine(surface, stretch, direction).distance_at(slope);
}

Stretch clip_stretch(const Surface& surface, const Stretch& stretch, glm::dvec2 direction,
                     double max_distance) {
  const StretchLine line(surface, stretch, direction);
  const bool near_inside = line.ray_length(line.near) < max_distance;
  const bool far_inside = line.ray_length(line.far) < max_distance;
  if (near_inside && far_inside) return stretch;
  Stretch clipped = stretch;
  // The line leaves the circle of radius max_distance about the start at
  // (1 + g²) r² − 2 g d r + d² − max_distance² = 0.
  const double g = line.gradient, d = line.depth, scale = 1 + g * g;
  const double discriminant = max_distance * max_distance * scale - d * d;
  const double root = std::sqrt(std::max(0.0, discriminant));
  const double enter = std::max(line.near, (g * d - root) / scale),
               leave = std::min(line.far, (g * d + root) / scale);
  if (discriminant <= 0 || enter >= leave) {
    clipped.high = clipped.low;
    return clipped;
  }
  if (!near_inside)
    clipped.low = std::clamp(static_cast<float>(line.slope_at(enter)), stretch.low, stretch.high);
  if (!far_inside) {
    clipped.high = std::clamp(static_cast<float>(line.slope_at(leave)), stretch.low, stretch.high);
    clipped.inverse_distance = static_cast<float>(1 / leave);
  }
  return clipped;
}

void append_stretch_links(const Surface& surface, const SliceOptions& options, const Stretch& stretch,
                          double weight, double rim, glm::dvec2 start, glm::dvec2 direction,
                          std::vector<Link>& links) {
  if (options.patches == Patches::kFacets) {
    links.push_back({stretch.facet, static_cast<float>(weight)});
    return;
  }
  const auto cosine_between = [&](double low, double high) {
    const SliceStretchSums sums = sums_between(low, high);
    return sums.vertical - rim * sums.horizontal;
  };
  const StretchLine line(surface, stretch, direction);
  const int pieces = 1 + static_cast<int>((line.far - line.near) / kLongestPiece);
  const double low_end = static_cast<double>(stretch.low), high_end = static_cast<double>(stretch.high);
  const double whole = cosine_between(low_end, high_end);
  double low = low_end;
  for (int piece = 1; piece <= pieces; ++piece) {
    const double end = line.near + (line.far - line.near) * piece / pieces;
    const double high = piece == pieces ? high_end : std::clamp(line.slope_at(end), low, high_end);
    const double share = pieces == 1 ? 1 : cosine_between(low, high) / whole;
    const glm::dvec2 position = start + line.distance_at((low + high) / 2) * direction;
    if (options.texel_links == TexelLinks::kNearest) {
      add_nearest_link(surface, position, weight * share, links);
    } else {
      add_bilinear_links(surface, position, weight * share, links);
    }
    low = high;
  }
}

}  // namespace hemibake
