#include "tracers/march/march.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>
#include <vector>

#include "core/constants.h"
#include "core/error.h"
#include "sampling/directions.h"
#include "sampling/low_discrepancy.h"
#include "surface/frame.h"
#include "surface/ray_outcome.h"
#include "tracers/hit_form_factors.h"

namespace hemibake {
namespace {

constexpr uint64_t kTexelRotation = 1;  // hash stream

// Returns the ray set of 2018 (MarchRays::kMayaux2018), cosine weights still 0.
std::vector<WeightedDirection> mayaux2018_rays(int count, double cone_degrees) {
  const double cos_max = cone_degrees >= 180 ? 0 : std::cos(cone_degrees * kPi / 360);
  std::vector<WeightedDirection> rays;
  for (int i = 1; i <= count; ++i) {
    const double cos_theta = cos_max + (1 - cos_max) * (i % count) / count;
    const double sin_theta = std::sqrt(1 - cos_theta * cos_theta);
    const double azimuth = 2 * kPi * radical_inverse(2, static_cast<uint32_t>(i));
    const glm::vec3 local(std::sin(azimuth) * sin_theta, -std::cos(azimuth) * sin_theta, cos_theta);
    rays.push_back({local, 1.0 / count, 0});
  }
  return rays;
}

std::vector<WeightedDirection> march_rays(const MarchOptions& options) {
  std::vector<WeightedDirection> rays =
      options.ray_set == MarchRays::kMayaux2018
          ? mayaux2018_rays(options.rays, options.cone_degrees)
          : make_directions(DirectionSet::kUniform, options.rays, options.cone_degrees);
  double cosine_sum = 0;
  for (const WeightedDirection& ray : rays) cosine_sum += static_cast<double>(ray.local.z);
  const bool exact = options.weights == MarchWeights::kExact;
  for (WeightedDirection& ray : rays) {
    // The single ray of N = 1 may lie on the horizon: it then has all the weight.
    const double share = cosine_sum > 0 ? static_cast<double>(ray.local.z) / cosine_sum : 1.0 / options.rays;
    ray.cosine_weight = exact ? share : 2.0 * static_cast<double>(ray.local.z) / options.rays;
  }
  return rays;
}

class MarchTracer final : public Tracer {
 public:
  MarchTracer(const Surface& surface, MarchOptions options);

  const Surface& surface() const override { return surface_; }
  const PatchSet& patch_set() const override { return patch_set_; }
  void trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const override;
  void trace_patch(uint32_t patch, bool with_links, Row& row, TracerCounts& counts) const override {
    trace_texel(patch, with_links, row, counts);
  }
  std::unique_ptr<Tracer> reseeded(uint64_t seed) const override {
    auto again = std::make_unique<MarchTracer>(*this);
    again->options_.seed = seed;
    return again;
  }
  std::vector<RayRecord> replay_texel(uint32_t texel) const override;

 private:
  void pad_heights();
  glm::dvec3 texel_start(uint32_t texel) const;
  Frame texel_frame(uint32_t texel) const;
  double height_at(double x, double y) const;
  RayOutcome march(const glm::dvec3& start, const glm::dvec3& direction, double* distance) const;
  glm::dvec2 into_map(const glm::dvec2& position) const;
  uint32_t facet_at(const glm::dvec2& position) const;

  const Surface& surface_;
  PatchSet patch_set_;
  MarchOptions options_;
  const bool wrap_, round_weights_;
  double zero_m_;  // height of the lowest texel over where heights count from
  // Lengths in texels from here on.
  std::vector<WeightedDirection> rays_;
  Grid<float> padded_heights_;  // one texel more on every side: texel (i, j) is at (i + 1, j + 1)
  double lift_, sky_, max_distance_;
};

MarchTracer::MarchTracer(const Surface& surface, MarchOptions options)
    : surface_(surface),
      patch_set_(make_patches(surface, PatchKind::kTexels)),
      options_(std::move(options)),
      wrap_(surface.edge == Edge::kWrap),
      round_weights_(options_.lookup == MarchLookup::kMayaux2018),
      rays_(march_rays(options_)) {
  if (!options_.normal_lengths.empty())
    expect_equal(options_.normal_lengths.size(), surface.heights_m.size(),
                 "normal lengths given to the march");
  const double range = height_range_m(surface);
  const double amplitude = options_.amplitude_m > 0 ? options_.amplitude_m : range;
  lift_ = options_.lift_percent / 100 * amplitude / surface.texel_size_m;
  zero_m_ = options_.lookup == MarchLookup::kMayaux2018 ? options_.lowest_m : 0;
  sky_ = std::max(amplitude, zero_m_ + range) / surface.texel_size_m;
  max_distance_ = options_.max_distance_m / surface.texel_size_m;
  pad_heights();
}

void MarchTracer::pad_heights() {
  const int width = surface_.width(), height = surface_.height();
  const Edge edge = options_.lookup == MarchLookup::kBilinear ? surface_.edge : Edge::kOpen;
  padded_heights_ = Grid<float>(width + 2, height + 2);
  for (int y = -1; y <= height; ++y) {
    for (int x = -1; x <= width; ++x) {
      const double height_m =
          surface_.heights_m(wrap_or_clamp(x, width, edge), wrap_or_clamp(y, height, edge));
      padded_heights_(x + 1, y + 1) = static_cast<float>((zero_m_ + height_m) / surface_.texel_size_m);
    }
  }
}

glm::dvec3 MarchTracer::texel_start(uint32_t texel) const {
  const int x = static_cast<int>(texel) % surface_.width(), y = static_cast<int>(texel) / surface_.width();
  return {x, y, static_cast<double>(padded_heights_(x + 1, y + 1)) + lift_};
}

// Returns the tangent frame; not orthonormal where the normal is not a unit vector, as in 2018.
Frame MarchTracer::texel_frame(uint32_t texel) const {
  const double length =
      options_.normal_lengths.empty() ? 1.0 : static_cast<double>(options_.normal_lengths[texel]);
  const Frame frame = frame_about(length * glm::dvec3(surface_.normals[texel]));
  if (options_.ray_set == MarchRays::kMayaux2018) return frame;
  return rotated(frame, 2 * kPi * unit_interval(mix_bits(options_.seed, kTexelRotation, texel)));
}

// Returns the height at a position, bilinear. -½ <= x < width − ½, y alike, texels.
double MarchTracer::height_at(double x, double y) const {
  const int i = static_cast<int>(x + 1), j = static_cast<int>(y + 1);
  double fx = x + 1 - i, fy = y + 1 - j;
  if (round_weights_) {
    fx = static_cast<int>(fx * 256 + 0.5) / 256.0;
    fy = static_cast<int>(fy * 256 + 0.5) / 256.0;
  }
  const float* top = &padded_heights_(i, j);
  const float* bottom = top + padded_heights_.width;
  const double high = top[0] + fx * (static_cast<double>(top[1]) - static_cast<double>(top[0]));
  const double low = bottom[0] + fx * (static_cast<double>(bottom[1]) - static_cast<double>(bottom[0]));
  return high + fy * (low - high);
}

// Marches a ray to its end. distance: of a hit along the ray, texels if |direction| = 1.
RayOutcome MarchTracer::march(const glm::dvec3& start, const glm::dvec3& direction, double* distance) const {
  const double horizontal = 1 - direction.z * direction.z;
  const glm::dvec3 step = direction * (horizontal > 0 ? 1 / std::sqrt(horizontal) : 1.0);
  const double width = surface_.width(), height = surface_.height();
  // On a wrapping map a step across several tiles equals its remainder.
  const double step_x = wrap_ && std::abs(step.x) >= width ? std::fmod(step.x, width) : step.x;
  const double step_y = wrap_ && std::abs(step.y) >= height ? std::fmod(step.y, height) : step.y;
  double x = start.x, y = start.y, z = start.z, height_before = start.z;
  for (int i = 1; i <= options_.max_steps; ++i) {
    z += step.z;
    if (z >= sky_) return RayOutcome::kEscaped;
    x += step_x;
    y += step_y;
    if (wrap_) {
      x = x < -0.5 ? x + width : x >= width - 0.5 ? x - width : x;
      y = y < -0.5 ? y + height : y >= height - 0.5 ? y - height : y;
    } else if (x < -0.5 || y < -0.5 || x >= width - 0.5 || y >= height - 0.5) {
      return RayOutcome::kEscaped;
    }
    const double here = height_at(x, y);
    if (z < here) {
      const double back = (here - z) / (2 * z - step.z + here - height_before);
      const double fraction = back > 0 ? std::min(back, 1.0) : 0.0;
      *distance = (i - fraction) * glm::length(step);
      return *distance > max_distance_ ? RayOutcome::kEscaped : RayOutcome::kHit;
    }
    height_before = here;
  }
  return RayOutcome::kTruncated;
}

// Returns a position wrapped or clamped into the map, texels.
glm::dvec2 MarchTracer::into_map(const glm::dvec2& position) const {
  const auto into_axis = [&](double v, double n) {
    if (v >= -0.5 && v < n - 0.5) return v;
    if (!wrap_) return std::clamp(v, 0.0, n - 1);
    const double r = std::fmod(v + 0.5, n);
    return (r < 0 ? r + n : r) - 0.5;
  };
  return {into_axis(position.x, surface_.width()), into_axis(position.y, surface_.height())};
}

uint32_t MarchTracer::facet_at(const glm::dvec2& position) const {
  // Open maps have a cell less in each direction than texels.
  const int columns = surface_.width() - (wrap_ ? 0 : 1), rows = surface_.height() - (wrap_ ? 0 : 1);
  const double x = std::floor(position.x), y = std::floor(position.y);
  const int column = wrap_or_clamp(static_cast<int>(x), columns, surface_.edge),
            row = wrap_or_clamp(static_cast<int>(y), rows, surface_.edge);
  const uint32_t cell = static_cast<uint32_t>(row * columns + column);
  return 2 * cell + (position.x - x + position.y - y < 1 ? 0 : 1);
}

void MarchTracer::trace_texel(uint32_t texel, bool with_links, Row& row, TracerCounts& counts) const {
  const glm::dvec3 start = texel_start(texel);
  const Frame frame = texel_frame(texel);
  double direct = 0;
  glm::dvec3 bent(0);
  size_t missed = 0;
  row.links.clear();
  for (const WeightedDirection& ray : rays_) {
    const glm::dvec3 direction = frame.world_from_tangent(glm::dvec3(ray.local));
    double distance = 0;
    const RayOutcome outcome = march(start, direction, &distance);
    if (outcome == RayOutcome::kHit) {
      if (with_links)
        add_nearest_form_factor(surface_, into_map(glm::dvec2(start) + distance * glm::dvec2(direction)),
                                ray.cosine_weight, row.links);
    } else {
      ++missed;
      direct += ray.cosine_weight;
      bent += direction;
      counts.truncated += outcome == RayOutcome::kTruncated;
    }
  }
  counts.rays += rays_.size();
  row.visible_fraction = static_cast<double>(missed) / static_cast<double>(rays_.size());
  row.direct_over_pi = direct;
  const double length = glm::length(bent);
  row.bent_normal = length > 1e-6 ? bent / length : glm::dvec3(surface_.normals[texel]);
  if (options_.weights == MarchWeights::kMayaux2018) {
    if (with_links) merge_form_factors(row.links);
    return;
  }
  // Exactly 1 on open ground, whatever the weights round to.
  row.direct_over_pi = missed == rays_.size() ? 1 : std::min(1.0, direct);
  if (with_links) complete_row(row);
}

std::vector<RayRecord> MarchTracer::replay_texel(uint32_t texel) const {
  const glm::dvec3 start = texel_start(texel);
  const Frame frame = texel_frame(texel);
  std::vector<RayRecord> records;
  for (const WeightedDirection& ray : rays_) {
    const glm::dvec3 direction = frame.world_from_tangent(glm::dvec3(ray.local));
    RayRecord record{glm::normalize(direction), ray.cosine_weight, ray.uniform_weight, false, 0, {}, 0, 0};
    double distance = 0;
    if (march(start, direction, &distance) == RayOutcome::kHit) {
      const glm::dvec2 straight = glm::dvec2(start) + distance * glm::dvec2(direction);
      record.hit = true;
      record.hit_texel = into_map(straight);
      record.facet = facet_at(record.hit_texel);
      record.distance_m = distance * surface_.texel_size_m;
      const glm::dvec2 tiles =
          glm::abs(straight - record.hit_texel) / glm::dvec2(surface_.width(), surface_.height());
      record.tiles_crossed = wrap_ ? static_cast<int>(std::min(std::round(tiles.x + tiles.y), 1e9)) : 0;
    }
    records.push_back(record);
  }
  return records;
}

}  // namespace

MarchOptions mayaux2018_march() {
  MarchOptions options;
  options.rays = 1024;
  options.cone_degrees = 179;
  options.ray_set = MarchRays::kMayaux2018;
  options.weights = MarchWeights::kMayaux2018;
  options.lookup = MarchLookup::kMayaux2018;
  return options;
}

std::unique_ptr<Tracer> make_march_tracer(const Surface& surface, MarchOptions options) {
  return std::make_unique<MarchTracer>(surface, std::move(options));
}

}  // namespace hemibake
