// Makes a geometry test chart: four by four solids on flat ground, each turned by an angle of its own.
// Lengths and heights are in units of the map's longer side; the tallest solid stands 0.45 high.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/constants.h"
#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

constexpr double kPitch = 0.25;
// Upright walls lean by this much over their height, so that they are not thinner than a texel on small maps.
constexpr double kDraft = 0.008;

enum class Solid { kBox, kPyramid, kFrustum, kCone, kDome, kCylinder, kRing, kRoof, kVault, kStairs };

struct Shape {
  Solid solid;
  double half_length,
      half_width;  // along the solid's own x and y; ring: radius of its crest, half its breadth
  double height;
};

// Row by row. Nothing reaches farther than half the pitch from its centre, however it is turned.
constexpr std::array<Shape, 16> kChart = {{
    {Solid::kBox, 0.05, 0.05, 0.45},
    {Solid::kPyramid, 0.08, 0.08, 0.16},
    {Solid::kDome, 0.1, 0.1, 0.1},
    {Solid::kRoof, 0.1, 0.06, 0.1},
    {Solid::kFrustum, 0.08, 0.08, 0.12},
    {Solid::kBox, 0.1, 0.03, 0.22},
    {Solid::kRing, 0.08, 0.03, 0.06},
    {Solid::kCone, 0.1, 0.1, 0.2},
    {Solid::kDome, 0.11, 0.06, 0.16},
    {Solid::kStairs, 0.09, 0.07, 0.2},
    {Solid::kPyramid, 0.06, 0.06, 0.32},
    {Solid::kCylinder, 0.07, 0.07, 0.28},
    {Solid::kVault, 0.1, 0.05, 0.05},
    {Solid::kCylinder, 0.1, 0.1, 0.06},
    {Solid::kBox, 0.07, 0.07, 0.12},
    {Solid::kRoof, 0.09, 0.025, 0.25},
}};

double elliptic(double squared) { return std::sqrt(std::max(0.0, 1 - squared)); }

// Returns a wall's share of its full height at a distance inside its foot.
double upright(double inside) { return std::clamp(inside / kDraft, 0.0, 1.0); }

double height_of(const Shape& shape, double x, double y) {
  const double along = std::abs(x) / shape.half_length, across = std::abs(y) / shape.half_width;
  const double radius = std::hypot(x, y);
  const double inside_end = shape.half_length - std::abs(x), inside_side = shape.half_width - std::abs(y);
  const double pyramid = std::max(0.0, 1 - std::max(along, across));
  switch (shape.solid) {
    case Solid::kBox:
      return shape.height * upright(std::min(inside_end, inside_side));
    case Solid::kPyramid:
      return shape.height * pyramid;
    case Solid::kFrustum:
      return shape.height * std::min(1.0, 2 * pyramid);
    case Solid::kCone:
      return shape.height * std::max(0.0, 1 - radius / shape.half_length);
    case Solid::kDome:
      return shape.height * elliptic(along * along + across * across);
    case Solid::kCylinder:
      return shape.height * upright(shape.half_length - radius);
    case Solid::kRing: {
      const double from_crest = (radius - shape.half_length) / shape.half_width;
      return shape.height * elliptic(from_crest * from_crest);
    }
    case Solid::kRoof:
      return shape.height * std::min(std::max(0.0, 1 - across), upright(inside_end));
    case Solid::kVault:
      return shape.height * std::min(elliptic(across * across), upright(inside_end));
    case Solid::kStairs: {
      constexpr double kSteps = 4;
      const double step_length = 2 * shape.half_length / kSteps;
      const double step = std::clamp((x + shape.half_length) / step_length, 0.0, kSteps);
      const double climbed = std::floor(step) + upright((step - std::floor(step)) * step_length);
      return shape.height * std::min(climbed / kSteps, upright(std::min(inside_end, inside_side)));
    }
  }
  return 0;
}

}  // namespace

Grid<float> make_shapes(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  const int columns = cells_along(tile.width, 1 / kPitch), rows = cells_along(tile.height, 1 / kPitch);
  const double pitch_x = tile.width / columns, pitch_y = tile.height / rows;
  // Solids shrink with their cell where a whole number of cells of the full pitch does not fit.
  const double scale = std::min({1.0, pitch_x / kPitch, pitch_y / kPitch});
  return fill_points(options, [&](double x, double y) {
    const int column = std::min(columns - 1, static_cast<int>(x / pitch_x));
    const int row = std::min(rows - 1, static_cast<int>(y / pitch_y));
    constexpr int kTurns = 24;  // of 15°
    const double turn = 2 * kPi / kTurns * std::floor(kTurns * hash_unit(options.seed, column, row));
    const double dx = (x - (column + 0.5) * pitch_x) / scale, dy = (y - (row + 0.5) * pitch_y) / scale;
    return scale * height_of(kChart[static_cast<size_t>(4 * (row % 4) + column % 4)],
                             std::cos(turn) * dx + std::sin(turn) * dy,
                             std::cos(turn) * dy - std::sin(turn) * dx);
  });
}

}  // namespace hemibake
