#include "tracers/slice_links.h"

#include <algorithm>
#include <cmath>

#include "surface/facets.h"
#include "tracers/link_merge.h"

namespace hemibake {
namespace {

// A facet in a slice: the line z = gradient · r − depth from the start, where r is the horizontal distance.
struct FacetLine {
  double gradient;
  double depth;  // ≥ 0: how far the facet's plane passes below the start
  double far;    // where the path leaves it

  // `high` is the slope there.
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

SliceStretchSums sums_between(double low_slope, double high_slope) {
  const double low = std::atan(low_slope), high = std::atan(high_slope);
  const double sin_low = std::sin(low), sin_high = std::sin(high);
  return {sin_high - sin_low, (high - low) / 2 + (std::sin(2 * high) - std::sin(2 * low)) / 4,
          (sin_high * sin_high - sin_low * sin_low) / 2};
}

double hit_distance(const Surface& surface, const SliceHit& hit, glm::dvec2 direction) {
  const FacetLine line(surface, hit.facet, direction, hit.high, hit.inverse_distance);
  return std::min(line.far, line.distance_at(static_cast<double>(hit.slope)));
}

Stretch clip_stretch(const Surface& surface, const Stretch& stretch, glm::dvec2 direction,
                     double max_distance) {
  const FacetLine line(surface, stretch.facet, direction, stretch.high, stretch.inverse_distance);
  const double near = std::min(line.far, line.distance_at(static_cast<double>(stretch.low)));
  const bool near_inside = line.ray_length(near) < max_distance;
  const bool far_inside = line.ray_length(line.far) < max_distance;
  if (near_inside && far_inside) return stretch;
  Stretch clipped = stretch;
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
    clipped.low = std::clamp(static_cast<float>(line.slope_at(enter)), stretch.low, stretch.high);
  if (!far_inside) {
    clipped.high = std::clamp(static_cast<float>(line.slope_at(leave)), stretch.low, stretch.high);
    clipped.inverse_distance = static_cast<float>(1 / leave);
  }
  return clipped;
}

void append_hits(const Stretch& stretch, double rim, float strata_per_weight, std::vector<SliceHit>& hits) {
  const double low = static_cast<double>(stretch.low), high = static_cast<double>(stretch.high);
  const int pieces = 1 + static_cast<int>(stretch.weight * strata_per_weight);
  double begin = low;
  for (int piece = 1; piece <= pieces; ++piece) {
    const double share = static_cast<double>(piece) / pieces;
    const double end = std::tan((1 - share) * std::atan(low) + share * std::atan(high));
    const SliceStretchSums sums = sums_between(begin, end);
    const double weight = sums.vertical - rim * sums.horizontal;
    hits.push_back({stretch.facet, static_cast<float>(weight), static_cast<float>((begin + end) / 2),
                    stretch.high, stretch.inverse_distance, stretch.azimuth});
    begin = end;
  }
}

void append_links(const Surface& surface, const PatchSet& patches, TexelLinks texel_links,
                  const SliceHit& hit, double weight, glm::dvec2 start, glm::dvec2 direction, double choice,
                  std::vector<Link>& links) {
  const double distance = hit_distance(surface, hit, direction);
  const glm::dvec2 position = start + distance * direction;
  if (patches.kind == Patches::kFacets) {
    const double ray_length =
        distance * std::sqrt(1 + static_cast<double>(hit.slope) * static_cast<double>(hit.slope));
    add_node_links(patches, hit.facet, facet_coordinates(surface, hit.facet, position), ray_length, choice,
                   weight, links);
    return;
  }
  if (texel_links == TexelLinks::kNearest) {
    add_nearest_link(surface, position, weight, links);
  } else {
    add_bilinear_links(surface, position, weight, links);
  }
}

}  // namespace hemibake
