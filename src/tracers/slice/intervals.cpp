#include "tracers/slice/intervals.h"

#include <algorithm>
#include <cmath>

#include "surface/facets.h"

namespace hemibake {
namespace {

// A facet in a slice: the line z = gradient · r − depth from the start, r the horizontal distance.
struct FacetLine {
  double gradient;
  double depth;  // ≥ 0: of the facet's plane below the start
  double far;    // distance at which the path leaves it

  // high, inverse_distance: slope and 1 / distance at which the path leaves the facet.
  FacetLine(const Surface& surface, uint32_t facet, glm::dvec2 direction, float high,
            float inverse_distance) {
    const glm::dvec3 normal = facet_normal(surface, facet);
    gradient = -(normal.x * direction.x + normal.y * direction.y) / normal.z;
    far = 1 / static_cast<double>(inverse_distance);
    depth = std::max(0.0, (gradient - static_cast<double>(high)) * far);
  }
  double distance_at(double slope) const { return slope < gradient ? depth / (gradient - slope) : far; }
  double slope_at(double distance) const { return gradient - depth / distance; }
  double ray_length(double distance) const { return std::hypot(distance, gradient * distance - depth); }
};

}  // namespace

IntervalIntegrals integrate_interval(double low_slope, double high_slope) {
  const double low = std::atan(low_slope), high = std::atan(high_slope);
  const double sin_low = std::sin(low), sin_high = std::sin(high);
  return {sin_high - sin_low, (high - low) / 2 + (std::sin(2 * high) - std::sin(2 * low)) / 4,
          (sin_high * sin_high - sin_low * sin_low) / 2};
}

double interval_distance(const Surface& surface, const VisibleInterval& interval, double slope,
                         glm::dvec2 direction) {
  const FacetLine line(surface, interval.facet, direction, interval.high, interval.inverse_distance);
  return std::min(line.far, line.distance_at(slope));
}

VisibleInterval clip_interval(const Surface& surface, const VisibleInterval& interval, glm::dvec2 direction,
                              double max_distance) {
  const FacetLine line(surface, interval.facet, direction, interval.high, interval.inverse_distance);
  const double near = std::min(line.far, line.distance_at(static_cast<double>(interval.low)));
  const bool near_inside = line.ray_length(near) < max_distance;
  const bool far_inside = line.ray_length(line.far) < max_distance;
  if (near_inside && far_inside) return interval;
  VisibleInterval clipped = interval;
  // The line leaves the circle of radius max_distance about the start at
  // (1 + g²) r² − 2 g d r + d² − max_distance² = 0.
  const double g = line.gradient, d = line.depth, scale = 1 + g * g;
  const double discriminant = max_distance * max_distance * scale - d * d;
  const double root = std::sqrt(std::max(0.0, discriminant));
  const double enter = std::max(near, (g * d - root) / scale),
               leave = std::min(line.far, (g * d + root) / scale);
  if (discriminant <= 0 || enter >= leave) {
    clipped.high = clipped.low;
    return clipped;
  }
  if (!near_inside)
    clipped.low = std::clamp(static_cast<float>(line.slope_at(enter)), interval.low, interval.high);
  if (!far_inside) {
    clipped.high = std::clamp(static_cast<float>(line.slope_at(leave)), interval.low, interval.high);
    clipped.inverse_distance = static_cast<float>(1 / leave);
  }
  return clipped;
}

void append_hits(const Surface& surface, const VisibleInterval& interval, const SliceRay& slice,
                 float hits_per_weight, std::vector<SliceHit>& hits) {
  const double low = static_cast<double>(interval.low), high = static_cast<double>(interval.high);
  const int pieces = 1 + static_cast<int>(interval.weight * hits_per_weight);
  double begin = low;
  for (int piece = 1; piece <= pieces; ++piece) {
    const double share = static_cast<double>(piece) / pieces;
    const double end = std::tan((1 - share) * std::atan(low) + share * std::atan(high));
    const double weight = integrate_interval(begin, end).cosine(slice.tangent_slope),
                 slope = (begin + end) / 2;
    const double distance = interval_distance(surface, interval, slope, slice.direction);
    const glm::vec2 uv(facet_coordinates(surface, interval.facet, slice.start + distance * slice.direction));
    hits.push_back({interval.facet, static_cast<float>(weight), uv.x, uv.y,
                    static_cast<float>(distance * std::hypot(1, slope))});
    begin = end;
  }
}

}  // namespace hemibake
