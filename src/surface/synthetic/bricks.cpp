// Makes a weathered wall in running bond. All lengths and heights are in units of the map's longer side:
// metres of a wall of one metre, whose relief of about a decimetre is stretched to 0..1 afterwards.
#include <algorithm>
#include <cmath>

#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

constexpr double kBrickPitch = 0.25, kCoursePitch = 1.0 / 12;
constexpr double kJointWidth = 0.012;
constexpr double kFaceHeight = 0.046;  // mean of the faces above the mean of the mortar
constexpr double kCornerRadius = 0.008;
constexpr double kEdgeRounding = 0.009;  // width of the worn edge

// Hash streams, one for everything that varies on its own.
enum class Stream {
  kWarpX,
  kWarpY,
  kJoints,
  kBricks,
  kOutline,
  kBites,
  kFace,
  kGrain,
  kSpalls,
  kPits,
  kPitShape,
  kGrit,
  kCracks,
  kMortar,
  kSmear,
  kHoles,
  kChips
};

struct BrickWall {
  Tile tile;
  int columns, courses;
  double highest_frequency;
  uint64_t seed;

  uint64_t stream(Stream name) const { return hash_bits(seed, 1, static_cast<int64_t>(name)); }
  double noise(double x, double y, double frequency, Stream name) const {
    return tile_noise(x, y, tile, frequency, stream(name));
  }
  double fractal(double x, double y, double frequency, double gain, Stream name) const {
    return fractal_noise(
        x, y, tile,
        {.frequency = frequency, .highest_frequency = highest_frequency, .gain = gain, .seed = stream(name)});
  }
};

BrickWall wall_of(const SyntheticOptions& options) {
  const Tile tile = tile_of(options);
  // An even number of courses, so that the bond goes on where the map repeats.
  return {tile, cells_along(tile.width, 1 / kBrickPitch), 2 * cells_along(tile.height, 0.5 / kCoursePitch),
          highest_frequency(options), options.seed};
}

// Random traits of a brick (chips: of its corners).
enum class Trait {
  kTurn,
  kShift,
  kLength,
  kHeight,
  kWear,
  kOffset,
  kTiltX,
  kTiltY,
  kSpall,
  kCrack,
  kChip,
  kChipSize,
  kChipLean,
  kChipSlope
};

// One brick and a point in its frame.
struct BrickPoint {
  double x, y;  // from the brick's centre
  double half_width, half_height;
  uint64_t bits;  // the brick's own

  // Returns a number uniform in [−1, 1).
  double random(Trait trait, int corner = 0) const {
    return 2 * hash_unit(bits, static_cast<int64_t>(trait), corner) - 1;
  }
};

// Returns the position of the head joint to the left of brick `column`, in columns.
double head_joint(const BrickWall& wall, int column, int course) {
  constexpr double kShift = 0.06;
  return column +
         kShift * (2 * hash_unit(wall.stream(Stream::kJoints), wrap_index(column, wall.columns), course) - 1);
}

BrickPoint brick_at(const BrickWall& wall, double x, double y) {
  const double v = y / wall.tile.height * wall.courses;
  const int row = static_cast<int>(std::floor(v));
  const int course = wrap_index(row, wall.courses);
  const double u = x / wall.tile.width * wall.columns - 0.5 * (course % 2);
  int column = static_cast<int>(std::floor(u));
  if (u < head_joint(wall, column, course)) --column;
  if (u >= head_joint(wall, column + 1, course)) ++column;
  const double left = head_joint(wall, column, course), right = head_joint(wall, column + 1, course);
  const double pitch_x = wall.tile.width / wall.columns, pitch_y = wall.tile.height / wall.courses;

  BrickPoint brick{};
  brick.bits = hash_bits(wall.stream(Stream::kBricks), wrap_index(column, wall.columns), course);
  const double dx = (u - (left + right) / 2) * pitch_x;
  const double dy = (v - row - 0.5) * pitch_y;
  // Laid by hand: turned a little, shifted a little, not all of a size.
  const double turn = 0.012 * brick.random(Trait::kTurn);
  brick.x = dx - turn * dy;
  brick.y = dy + turn * dx + 0.0015 * brick.random(Trait::kShift);
  brick.half_width = (right - left) * pitch_x / 2 - kJointWidth * (0.5 + 0.12 * brick.random(Trait::kLength));
  brick.half_height = pitch_y / 2 - kJointWidth * (0.5 + 0.12 * brick.random(Trait::kHeight));
  return brick;
}

// Returns the distance from the outline, positive inside: a rounded rectangle, frayed by noise, with bites
// out of it.
double outline_distance(const BrickWall& wall, const BrickPoint& brick, double x, double y) {
  const double qx = std::abs(brick.x) - (brick.half_width - kCornerRadius);
  const double qy = std::abs(brick.y) - (brick.half_height - kCornerRadius);
  const double outside = std::hypot(std::max(qx, 0.0), std::max(qy, 0.0)) + std::min(std::max(qx, qy), 0.0);
  const double fray = 0.0045 * wall.fractal(x, y, 36, 0.6, Stream::kOutline);
  const double bite = 0.013 * smooth_step(0.15, 0.6, wall.fractal(x, y, 20, 0.6, Stream::kBites));
  return kCornerRadius - outside + fray - bite;
}

// Returns the depth of a broken-off corner below the face, 0 off it.
double chip_depth(const BrickWall& wall, const BrickPoint& brick, double x, double y) {
  const int corner = (brick.x > 0 ? 1 : 0) + (brick.y > 0 ? 2 : 0);
  if (brick.random(Trait::kChip, corner) < 0.2) return 0;
  const double size = 0.015 + 0.035 * std::abs(brick.random(Trait::kChipSize, corner));
  // The fracture leans towards the bed or the head joint.
  const double lean = 0.5 + 0.4 * brick.random(Trait::kChipLean, corner);
  const double from_corner = 2 * (lean * (brick.half_width - std::abs(brick.x)) +
                                  (1 - lean) * (brick.half_height - std::abs(brick.y)));
  const double fracture = from_corner + 0.006 * wall.fractal(x, y, 50, 0.55, Stream::kChips);
  return std::max(0.0, size - fracture) * (0.7 + 0.5 * std::abs(brick.random(Trait::kChipSlope, corner)));
}

double pit_depth(const BrickWall& wall, double x, double y) {
  const Spot spot = nearest_spot(x, y, wall.tile, 40, wall.stream(Stream::kPits));
  if (hash_unit(spot.bits, 1, 0) > 0.25) return 0;
  const double size = hash_unit(spot.bits, 1, 1);
  const double radius = 0.002 + 0.006 * size * size * size;
  // Not round: the distance is warped by noise.
  const double t = spot.distance / radius + 0.6 * wall.fractal(x, y, 90, 0.5, Stream::kPitShape);
  return t < 1 ? 2 * radius * (1 - std::max(0.0, t)) : 0.0;
}

// Returns the height of grit that stands out of the weathered face.
double grit_height(const BrickWall& wall, double x, double y) {
  const Spot spot = nearest_spot(x, y, wall.tile, 50, wall.stream(Stream::kGrit));
  if (hash_unit(spot.bits, 1, 0) > 0.3) return 0;
  const double radius = 0.003 + 0.005 * hash_unit(spot.bits, 1, 1);
  return 0.7 * std::max(0.0, radius - spot.distance);
}

// Returns the depth of a crack along the zero line of a noise, on bricks that have one.
double crack_depth(const BrickWall& wall, const BrickPoint& brick, double x, double y) {
  if (brick.random(Trait::kCrack) < 0.6) return 0;
  const double from_line = std::abs(wall.fractal(x, y, 6, 0.4, Stream::kCracks));
  return 0.009 * (1 - smooth_step(0.0, 0.016, from_line));
}

double face_height(const BrickWall& wall, const BrickPoint& brick, double x, double y) {
  // Hard-burnt bricks have weathered least: they are smoother, flatter and stand proud.
  const double wear = 0.5 + 0.5 * brick.random(Trait::kWear);
  double height = kFaceHeight + 0.010 * brick.random(Trait::kOffset) - 0.013 * wear;
  height += wear * (0.06 * brick.random(Trait::kTiltX) * brick.x +
                    0.12 * brick.random(Trait::kTiltY) * brick.y - 3.0 * brick.y * brick.y);
  height += (0.002 + 0.021 * wear) * wall.noise(x, y, 13, Stream::kFace);
  height += (0.0005 + 0.0085 * wear) * wall.fractal(x, y, 45, 0.6, Stream::kGrain);
  height += grit_height(wall, x, y);
  // Spalled skin: a sharp-edged shallow layer gone.
  const double spall = wall.fractal(x, y, 9, 0.55, Stream::kSpalls) + 0.25 * brick.random(Trait::kSpall);
  height -= 0.006 * smooth_step(0.22, 0.26, spall);
  return height - pit_depth(wall, x, y) - chip_depth(wall, brick, x, y) - crack_depth(wall, brick, x, y);
}

double mortar_height(const BrickWall& wall, double x, double y) {
  double height = 0.007 * wall.fractal(x, y, 60, 0.7, Stream::kMortar);
  // Smeared full in places, washed out in others.
  height += 0.036 * smooth_step(0.0, 0.5, wall.fractal(x, y, 7, 0.5, Stream::kSmear));
  return height - 0.034 * smooth_step(0.05, 0.6, wall.fractal(x, y, 24, 0.5, Stream::kHoles));
}

double wall_height(const BrickWall& wall, double x, double y) {
  // Courses that are not drawn with a ruler.
  const double warped_x = x + 0.004 * wall.noise(x, y, 9, Stream::kWarpX);
  const double warped_y = y + 0.005 * wall.noise(x, y, 7, Stream::kWarpY);
  const BrickPoint brick = brick_at(wall, warped_x, warped_y);
  const double mortar = mortar_height(wall, x, y);
  const double inside = outline_distance(wall, brick, x, y);
  if (inside <= 0) return mortar;
  const double from_top = 1 - std::min(1.0, inside / kEdgeRounding);
  const double edge = 0.4 + 0.6 * std::sqrt(1 - from_top * from_top);
  return std::max(mortar, std::lerp(mortar, face_height(wall, brick, x, y), edge));
}

}  // namespace

Grid<float> make_bricks(const SyntheticOptions& options) {
  const BrickWall wall = wall_of(options);
  return fill_points(options, [&](double x, double y) { return wall_height(wall, x, y); });
}

}  // namespace hemibake
