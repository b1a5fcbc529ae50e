// The truth of a study: vertical slices whose own error is small against that of the best run.
//
// Averages independent seeds and sets of azimuths. src/trade/README.md says how it converges.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "reference/comparison.h"
#include "surface/surface.h"
#include "trade/light_models.h"
#include "trade/sweep.h"
#include "trade/trade_run.h"

namespace hemibake {

inline constexpr int kReferenceBounces = 200;  // 0.95²⁰⁰ is 4·10⁻⁵
// Largest error of the reference, as a share of the best run's.
inline constexpr double kReferenceShare = 0.2;
// Errors below it are rounding, whatever their share.
inline constexpr double kRoundingError = 1e-6;

struct ReferenceOptions {
  Effort effort = Effort::kNormal;
  size_t memory_bytes = size_t{4} << 30;  // for links: where azimuths do not fit, seeds are added
};

// One number per plane of named_planes().
using PlaneValues = std::array<double, kPlaneCount>;

struct ReferenceFacts {
  int width = 0, height = 0;  // texels
  bool can_halve = false;     // trade/resample.h
  double height_range_m = 0;
  double texel_size_m = 0;
  int bounces = kReferenceBounces;
  int azimuths_ao = 0, azimuths_light = 0;  // of the seed with the fewest
  int seeds_light = 0;
  PlaneValues mean{};
  // rms(A − B)/2 of two groups of seeds: the standard error of their mean, without errors both share. The
  // referee, an unbiased path tracer on a sample of texels, is the check on those.
  PlaneValues error{};
  PlaneValues best_run_error{};     // rms of the highest level, the reference's own error taken out
  std::vector<RefereeRow> referee;  // over the map
  FittedModels models;
  std::vector<LightModelErrors> models_on_true_ao;
  double cpu_seconds = 0;
};

struct Reference {
  RunPlanes planes;  // all of them
  ReferenceFacts facts;
};

Reference make_reference(const Surface& surface, const ReferenceOptions& options);

// Returns a run's rms error without that of the reference, which is independent: √(rmse² − reference²).
double own_error(double rmse, double reference_error);

}  // namespace hemibake
