// Synthesizes height maps: materials made from hashed noise, and shapes whose light has a closed form.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/grid.h"

namespace hemibake {

enum class SyntheticKind {
  kBricks,
  kShapes,
  kConcrete,
  kNoise,
  kCobbles,
  kGravel,
  kPlanks,
  kTiles,
  kWeave,
  kMud,
  kStairs,
  kTrenches,
  kDunes,
  kTerrain,
  kFlat,
  kBowl,
  kGroove,
  kCanyon,
  kStep
};

// Angles of the kinds that have one.
inline constexpr double kMinSyntheticAngleDeg = 1, kMaxSyntheticAngleDeg = 89;

struct SyntheticKindInfo {
  SyntheticKind kind;
  const char* name;
  const char* description;                  // one line
  std::optional<double> default_angle_deg;  // only of kinds with an angle
};

// Returns every kind, in the order of the enumeration.
std::span<const SyntheticKindInfo> synthetic_kinds();

struct SyntheticOptions {
  int width = 512;   // texels, at least 1
  int height = 512;  // texels, at least 1
  uint64_t seed = 1;
  // bowl: polar half-angle T of the spherical cap; groove: half-angle ψ between a wall and the vertical.
  // 1°..89°; the kind's default where absent, not allowed where the kind has none.
  std::optional<double> angle_rad;
};

struct SyntheticMap {
  Grid<float> heights;  // 0..1, both attained unless the map is flat or has too few texels for its shape
  double recommended_amplitude_m;  // for a map of 1 m along its longer side; in proportion for other sizes
};

// Makes a map; the same bytes on every run and at any thread count. Features are measured in units of the
// longer side, so that they keep their shape on maps that are not square, and every kind continues without a
// seam where the map repeats. Throws InputError for sizes and angles outside the ranges above.
SyntheticMap synthesize(SyntheticKind kind, const SyntheticOptions& options);

}  // namespace hemibake
