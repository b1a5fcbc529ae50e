#include "estimators/horizon.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "core/constants.h"
#include "core/parallel.h"
#include "core/progress.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

// Nearest sample: closer ones show only the facets at the texel itself.
constexpr double kNearestSampleTexels = 0.5;

// Returns the height of the triangles at x, y (texels, centres at whole numbers), or nullopt beyond an open
// edge.
std::optional<double> height_at(const Surface& surface, double x, double y) {
  const double cell_x = std::floor(x), cell_y = std::floor(y);
  const int w = surface.width(), h = surface.height();
  if (surface.edge != Edge::kWrap && (cell_x < 0 || cell_y < 0 || cell_x >= w - 1 || cell_y >= h - 1))
    return std::nullopt;
  const int i = wrap_index(static_cast<int>(cell_x), w), j = wrap_index(static_cast<int>(cell_y), h);
  const auto corner = [&](int dx, int dy) -> double { return surface.heights_m((i + dx) % w, (j + dy) % h); };
  const double u = x - cell_x, v = y - cell_y;
  const double right = corner(1, 0), below = corner(0, 1);
  if (u + v <= 1) {
    const double base = corner(0, 0);
    return base + u * (right - base) + v * (below - base);
  }
  const double base = corner(1, 1);
  return base + (1 - u) * (below - base) + (1 - v) * (right - base);
}

// Sky of one texel, summed over its slices.
struct SkySum {
  double uniform = 0, cosine = 0;
  glm::dvec3 direction{0};

  // Adds the sky between the angles `low` ≤ 0 and `high` ≥ 0 from the vertical, in the slice along `side`.
  void add_slice(const glm::dvec3& side, double projected_length, double gamma, double low, double high) {
    for (const double h : {low, high}) {
      uniform += 0.5 * (1 - std::cos(h));
      cosine +=
          projected_length * 0.25 * (-std::cos(2 * h - gamma) + std::cos(gamma) + 2 * h * std::sin(gamma));
      // ∫ (sinθ side + cosθ z) |sinθ| dθ from 0 to h.
      direction += (0.5 * std::abs(h) - 0.25 * std::sin(2 * std::abs(h))) * std::copysign(1.0, h) * side;
      direction.z += 0.5 * std::sin(h) * std::sin(h);
    }
  }
};

struct HorizonSearch {
  const Surface& surface;
  const HorizonOptions& options;
  double radius_texels;
  double open_angle;  // from the vertical to the horizon if nothing rises

  // Returns the angle from the vertical to the highest of the samples at these distances along a direction.
  double horizon(int x, int y, const glm::dvec2& direction, const std::vector<double>& distances) const {
    const double here = surface.heights_m(x, y);
    double highest_slope = -HUGE_VAL;
    for (const double distance : distances) {
      const auto height = height_at(surface, x + distance * direction.x, y + distance * direction.y);
      if (!height) break;
      highest_slope = std::max(highest_slope, (*height - here) / (distance * surface.texel_size_m));
    }
    if (highest_slope == -HUGE_VAL) return open_angle;
    return std::min(open_angle, kPi / 2 - std::atan(highest_slope));
  }

  std::vector<double> sample_distances(double shift) const {
    std::vector<double> distances(static_cast<size_t>(options.steps));
    for (int k = 0; k < options.steps; ++k) {
      const double far = radius_texels * std::pow((k + shift) / options.steps, options.step_power);
      distances[static_cast<size_t>(k)] = std::max(far, kNearestSampleTexels);
    }
    return distances;
  }

  SkySum sky_of(int x, int y) const {
    const uint64_t texel = surface.heights_m.index(x, y);
    const double rotation = options.jitter ? unit_interval(mix_bits(options.seed, texel, 0)) : 0.0;
    // 1 − u lies in (0, 1].
    const double shift = options.jitter ? 1 - unit_interval(mix_bits(options.seed, texel, 1)) : 1.0;
    const std::vector<double> distances = sample_distances(shift);
    const glm::dvec3 normal(surface.normals(x, y));
    const int slices = options.azimuths / 2;
    SkySum sky;
    for (int slice = 0; slice < slices; ++slice) {
      const double azimuth = kPi * (slice + rotation) / slices;
      const glm::dvec2 along(std::cos(azimuth), std::sin(azimuth));
      const double run = normal.x * along.x + normal.y * along.y;
      const double gamma = std::atan2(run, normal.z);
      const double low = std::max(-horizon(x, y, -along, distances), gamma - kPi / 2);
      const double high = std::min(horizon(x, y, along, distances), gamma + kPi / 2);
      sky.add_slice({along.x, along.y, 0}, std::hypot(run, normal.z), gamma, low, high);
    }
    sky.uniform /= slices;
    sky.cosine /= slices;
    return sky;
  }
};

}  // namespace

Estimate estimate_horizon(const Surface& surface, const HorizonOptions& options) {
  const double radius_m = options.radius_m > 0 ? options.radius_m : far_radius_m(surface);
  const HorizonSearch search{surface, options, radius_m / surface.texel_size_m,
                             surface.edge == Edge::kOpen ? kPi : kPi / 2};
  Estimate estimate;
  estimate.kind = options.kind;
  estimate.ao = Grid<float>(surface.width(), surface.height());
  estimate.other_ao = estimate.ao;
  estimate.bent_normals = Grid<glm::vec3>(surface.width(), surface.height());
  estimate.work =
      surface.texel_count() * static_cast<uint64_t>(options.azimuths) * static_cast<uint64_t>(options.steps);

  Progress progress("horizon", estimate.ao.size(), "texel");
  parallel_for(static_cast<size_t>(surface.height()), 1, [&](size_t begin, size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < surface.width(); ++x) {
        const SkySum sky = search.sky_of(x, y);
        const bool cosine = options.kind == AoKind::kCosine;
        const auto ao = [](double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); };
        estimate.ao(x, y) = ao(cosine ? sky.cosine : sky.uniform);
        estimate.other_ao(x, y) = ao(cosine ? sky.uniform : sky.cosine);
        const double length = glm::length(sky.direction);
        estimate.bent_normals(x, y) = length > 0 ? glm::vec3(sky.direction / length) : surface.normals(x, y);
      }
    }
    progress.advance((end - begin) * static_cast<uint64_t>(surface.width()));
  });
  return estimate;
}

}  // namespace hemibake
