#include "surface/synthetic/synthetic.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "surface/surface.h"
#include "surface/synthetic/analytic.h"
#include "surface/synthetic/kinds.h"

namespace hemibake {
namespace {

constexpr std::array kKinds = {
    SyntheticKindInfo{
        SyntheticKind::kBricks, "bricks", "weathered brick wall with deep joints, chips and pits", {}},
    SyntheticKindInfo{
        SyntheticKind::kShapes, "shapes", "test chart of boxes, pyramids, domes and ridges", {}},
    SyntheticKindInfo{
        SyntheticKind::kConcrete, "concrete", "shallow cast concrete with pores and fine grain", {}},
    SyntheticKindInfo{SyntheticKind::kNoise, "noise", "fractal gradient noise, hills down to grain", {}},
    SyntheticKindInfo{SyntheticKind::kCobbles, "cobbles", "rounded paving stones in sandy joints", {}},
    SyntheticKindInfo{SyntheticKind::kGravel, "gravel", "pebbles of three sizes on one another", {}},
    SyntheticKindInfo{SyntheticKind::kPlanks, "planks", "weathered boards with open joints and grain", {}},
    SyntheticKindInfo{
        SyntheticKind::kTiles, "tiles", "square tiles with sunken joints, some sagged or gone", {}},
    SyntheticKindInfo{SyntheticKind::kWeave, "weave", "round strands woven one over, one under", {}},
    SyntheticKindInfo{SyntheticKind::kMud, "mud", "dried mud: curled plates between two sizes of cracks", {}},
    SyntheticKindInfo{SyntheticKind::kStairs, "stairs", "flights side by side that climb and descend", {}},
    SyntheticKindInfo{SyntheticKind::kTrenches, "trenches", "winding steep trenches in flat ground", {}},
    SyntheticKindInfo{
        SyntheticKind::kDunes, "dunes", "wind-blown crests with a steep lee side, and ripples", {}},
    SyntheticKindInfo{SyntheticKind::kTerrain, "terrain", "ridged mountains with filled valleys", {}},
    SyntheticKindInfo{SyntheticKind::kFlat, "flat", "flat ground", {}},
    SyntheticKindInfo{SyntheticKind::kBowl, "bowl",
                      "spherical-cap pit of polar half-angle ANGLE in flat ground", 60},
    SyntheticKindInfo{SyntheticKind::kGroove, "groove", "V-grooves along y, walls ANGLE off the vertical",
                      45},
    SyntheticKindInfo{
        SyntheticKind::kCanyon, "canyon", "flat floor between two walls along y, one texel wide", {}},
    SyntheticKindInfo{SyntheticKind::kStep, "step", "one long wall along y, one texel wide", {}},
};

const SyntheticKindInfo& kind_info(SyntheticKind kind) { return kKinds[static_cast<size_t>(kind)]; }

SyntheticOptions checked(SyntheticKind kind, SyntheticOptions options) {
  if (options.width < 1 || options.height < 1 ||
      static_cast<uint64_t>(options.width) * static_cast<uint64_t>(options.height) > kMaxTexels)
    throw InputError(fmt::format("a map of {}x{} texels, expected at least 1x1 and at most {} texels",
                                 options.width, options.height, kMaxTexels));
  const SyntheticKindInfo& info = kind_info(kind);
  if (!info.default_angle_deg) {
    if (options.angle_rad) throw InputError(fmt::format("{} has no angle, expected none", info.name));
    return options;
  }
  if (!options.angle_rad) options.angle_rad = *info.default_angle_deg * kPi / 180;
  const double angle_deg = *options.angle_rad * 180 / kPi;
  constexpr double kRounding = 1e-9;
  if (!(angle_deg >= kMinSyntheticAngleDeg - kRounding && angle_deg <= kMaxSyntheticAngleDeg + kRounding))
    throw InputError(fmt::format("angle of {} degrees, expected {} to {}", angle_deg, kMinSyntheticAngleDeg,
                                 kMaxSyntheticAngleDeg));
  return options;
}

// Returns the map with its lowest texel at 0 and its highest at 1; flat maps at 0.
Grid<float> stretched(Grid<float> map) {
  const auto [lowest, highest] = std::minmax_element(map.values.begin(), map.values.end());
  const double low = *lowest, range = *highest - low;
  for (float& height : map.values) height = range > 0 ? static_cast<float>((height - low) / range) : 0.0f;
  return map;
}

double texel_m(const SyntheticOptions& options) { return 1.0 / std::max(options.width, options.height); }

}  // namespace

std::span<const SyntheticKindInfo> synthetic_kinds() { return kKinds; }

// Makes the noise map. Eight cells a side in the first octave; each octave has twice the frequency and 0.45
// of the amplitude of the one before, down to cells of two texels: amplitude falls like f^−1.15, slope like
// f^−0.15, power per unit of frequency like f^−3.3.
Grid<float> make_noise(const SyntheticOptions& options) {
  const FractalNoise noise{
      .frequency = 8, .highest_frequency = highest_frequency(options), .gain = 0.45, .seed = options.seed};
  const Tile tile = tile_of(options);
  return fill_points(options, [&](double x, double y) { return fractal_noise(x, y, tile, noise); });
}

SyntheticMap synthesize(SyntheticKind kind, const SyntheticOptions& requested) {
  const SyntheticOptions options = checked(kind, requested);
  switch (kind) {
    case SyntheticKind::kBricks:
      return {stretched(make_bricks(options)), 0.1};
    case SyntheticKind::kShapes:
      return {stretched(make_shapes(options)), 0.45};
    case SyntheticKind::kConcrete:
      return {stretched(make_concrete(options)), 0.05};
    case SyntheticKind::kNoise:
      return {stretched(make_noise(options)), 0.1};
    case SyntheticKind::kCobbles:
      return {stretched(make_cobbles(options)), 0.06};
    case SyntheticKind::kGravel:
      return {stretched(make_gravel(options)), 0.08};
    case SyntheticKind::kPlanks:
      return {stretched(make_planks(options)), 0.05};
    case SyntheticKind::kTiles:
      return {stretched(make_tiles(options)), 0.04};
    case SyntheticKind::kWeave:
      return {stretched(make_weave(options)), 0.08};
    case SyntheticKind::kMud:
      return {stretched(make_mud(options)), 0.07};
    case SyntheticKind::kStairs:
      return {stretched(make_stairs(options)), 0.3};
    case SyntheticKind::kTrenches:
      return {stretched(make_trenches(options)), 0.12};
    case SyntheticKind::kDunes:
      return {stretched(make_dunes(options)), 0.08};
    case SyntheticKind::kTerrain:
      return {stretched(make_terrain(options)), 0.25};
    case SyntheticKind::kFlat:
      return {Grid<float>(options.width, options.height), 0.1};
    case SyntheticKind::kBowl: {
      const BowlGeometry bowl = bowl_geometry(options.width, options.height, *options.angle_rad);
      return {make_bowl(options), bowl.depth * texel_m(options)};
    }
    case SyntheticKind::kGroove:
      return {make_groove(options),
              groove_geometry(options.width, *options.angle_rad).depth * texel_m(options)};
    case SyntheticKind::kCanyon: {
      // As deep as half the opening: both walls rise 45° above the middle of the floor.
      const WallGeometry walls = canyon_geometry(options.width);
      return {make_canyon(options), 0.5 * (walls.right_edge - walls.left_edge) * texel_m(options)};
    }
    case SyntheticKind::kStep: {
      // The wall rises 45° above the middle of the floor.
      const WallGeometry walls = step_geometry(options.width);
      return {make_step(options), 0.5 * (walls.right_edge - walls.left_edge) * texel_m(options)};
    }
  }
  throw std::logic_error("synthesize: unknown kind");
}

}  // namespace hemibake
