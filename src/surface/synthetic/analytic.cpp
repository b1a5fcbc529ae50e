#include "surface/synthetic/analytic.h"

#include <algorithm>
#include <cmath>

#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

Grid<float> make_floor(const SyntheticOptions& options, WallGeometry walls) {
  return fill_texels(options,
                     [&](int i, int) { return i > walls.left_edge && i < walls.right_edge ? 0.0 : 1.0; });
}

}  // namespace

BowlGeometry bowl_geometry(int width, int height, double angle_rad) {
  const double rim_radius = 0.45 * std::min(width, height);
  return {width / 2, height / 2, rim_radius, rim_radius / std::sin(angle_rad),
          rim_radius * std::tan(angle_rad / 2)};
}

GrooveGeometry groove_geometry(int width, double angle_rad) {
  // About four grooves: of the even divisors, the one whose ratio to a quarter of the width is nearest to 1.
  const double wanted = width / 4.0;
  const auto ratio = [&](int period) { return std::max(period / wanted, wanted / period); };
  int period = width;
  for (int even = 2; even < width; even += 2)
    if (width % even == 0 && ratio(even) < ratio(period)) period = even;
  const int wall_width = period / 2;
  return {period, wall_width, wall_width / std::tan(angle_rad)};
}

WallGeometry canyon_geometry(int width) { return {width / 4 - 1, width - width / 4}; }

WallGeometry step_geometry(int width) { return {width / 2 - 1, width}; }

Grid<float> make_bowl(const SyntheticOptions& options) {
  const BowlGeometry bowl = bowl_geometry(options.width, options.height, *options.angle_rad);
  return fill_texels(options, [&](int i, int j) {
    const double dx = i - bowl.center_x, dy = j - bowl.center_y;
    const double squared = dx * dx + dy * dy;
    if (squared >= bowl.rim_radius * bowl.rim_radius) return 1.0;
    // R − √(R² − d²) without the cancellation near the lowest point.
    const double radius = bowl.sphere_radius;
    return squared / (radius + std::sqrt(radius * radius - squared)) / bowl.depth;
  });
}

Grid<float> make_groove(const SyntheticOptions& options) {
  const GrooveGeometry groove = groove_geometry(options.width, *options.angle_rad);
  return fill_texels(options, [&](int i, int) {
    const int along = i % groove.period;
    return std::min(along, groove.period - along) / std::max(1.0, 1.0 * groove.wall_width);
  });
}

Grid<float> make_canyon(const SyntheticOptions& options) {
  return make_floor(options, canyon_geometry(options.width));
}

Grid<float> make_step(const SyntheticOptions& options) {
  return make_floor(options, step_geometry(options.width));
}

}  // namespace hemibake
