#include "terrain/horizon_tracer.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "terrain/horizon_path.h"
#include "terrain/horizon_walk.h"

namespace hemibake {
namespace {

constexpr double kFarthestTexels = 65536, kFarthestRanges = 1e4;

// Texels a side of the blocks that the windows of each level are made of.
constexpr std::array<int, kWindowLevels> kBlocks = {4, 16, 64};

}  // namespace

HorizonTracer::HorizonTracer(const Surface& surface, const HorizonReach& reach, bool inverted)
    : field_(surface, inverted) {
  radius_ = reach.radius_m / surface.texel_size_m;
  drop_ = reach.drop_per_m2 * surface.texel_size_m;
  longest_ = std::hypot(field_.width, field_.height);
  if (field_.edge == Edge::kWrap)
    longest_ = std::min(kFarthestTexels, kFarthestRanges * height_range_m(surface) / surface.texel_size_m);
  longest_ = std::min(longest_, radius_);
  const bool ends_at_horizontal = field_.edge != Edge::kOpen && std::isinf(radius_) && drop_ == 0;
  lowest_slope_ = ends_at_horizontal ? 0 : -HUGE_VAL;
  for (size_t level = 0; level < kWindowLevels; ++level)
    block_maxima_[level] = block_maxima(field_, kBlocks[level]);
}

// Returns the distance at which a path from (x, y) leaves the map, texels.
double HorizonTracer::distance_to_border(const HorizonPath& path, int x, int y) const {
  const auto along = [](double direction, int i, int n) {
    if (direction == 0) return HUGE_VAL;
    return direction > 0 ? (n - 1 - i) / direction : i / -direction;
  };
  return std::min(along(path.x, x, field_.width), along(path.y, y, field_.height));
}

// Returns the steepest slope to the ground that goes on level from the border.
double HorizonTracer::ground_slope(const HorizonPath& path, int x, int y, double border) const {
  const double at_x = std::clamp(x + border * path.x, 0.0, field_.width - 1.0),
               at_y = std::clamp(y + border * path.y, 0.0, field_.height - 1.0);
  const int i = std::min(static_cast<int>(at_x), field_.width - 2),
            j = std::min(static_cast<int>(at_y), field_.height - 2);
  const double u = at_x - i, v = at_y - j;
  const auto height = [&](int dx, int dy) { return static_cast<double>(*field_.at(i + dx, j + dy)); };
  const double rise = (1 - v) * ((1 - u) * height(0, 0) + u * height(1, 0)) +
                      v * ((1 - u) * height(0, 1) + u * height(1, 1)) - static_cast<double>(*field_.at(x, y));
  // rise / r − drop · r has its maximum where r² = −rise / drop.
  const double farthest = drop_ > 0 && rise < 0 ? std::sqrt(-rise / drop_) : rise < 0 ? HUGE_VAL : border;
  const double distance = std::clamp(farthest, border, std::max(border, radius_));
  return distance > 0 ? rise / distance - drop_ * distance : 0;
}

void HorizonTracer::add_ground(const HorizonPath& path, int y, Grid<float>& slopes) const {
  for (int x = 0; x < field_.width; ++x) {
    const double border = distance_to_border(path, x, y);
    if (border < radius_)
      slopes(x, y) = std::max(slopes(x, y), static_cast<float>(ground_slope(path, x, y, border)));
  }
}

Grid<float> HorizonTracer::trace(double azimuth) const {
  const HorizonPath path = find_horizon_path(azimuth, longest_, drop_, field_.heights.width);
  HorizonWalk walk{field_, path, {}, static_cast<float>(lowest_slope_), drop_ > 0};
  for (size_t level = 0; level < kWindowLevels; ++level)
    walk.maxima[level] = WindowMaxima(field_, block_maxima_[level], kBlocks[level],
                                      window_texels(path.x, path.y, level) + kHorizonLanes - 1,
                                      window_texels(path.y, path.x, level));
  const bool over_ground = field_.edge == Edge::kGround && lowest_slope_ < 0;
  Grid<float> slopes(field_.width, field_.height);
  parallel_for(static_cast<size_t>(field_.height), 1, [&](size_t begin, size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      walk_row(walk, y, {&slopes(0, y), static_cast<size_t>(field_.width)});
      if (over_ground) add_ground(path, y, slopes);
    }
  });
  return slopes;
}

}  // namespace hemibake
