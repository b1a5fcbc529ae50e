// What the runs of a study are compared with: vertical slices with so many azimuths, averaged over
// independent seeds and sets of azimuths, that their own error is small against that of the best run.
#pragma once

#include <nlohmann/json.hpp>

#include "surface/surface.h"
#include "trade/ladder.h"
#include "trade/light_models.h"
#include "trade/trade_run.h"

namespace hemibake {

inline constexpr int kReferenceBounces = 200;  // 0.95²⁰⁰ is 4·10⁻⁵
// The reference's error is to be at most this share of the best run's.
inline constexpr double kReferenceShare = 0.2;

struct ReferenceOptions {
  Effort effort = Effort::kNormal;
  size_t memory_bytes = size_t{4} << 30;  // for links: where azimuths do not fit, seeds are added
};

struct Reference {
  RunPlanes planes;  // all of them
  FittedModels fitted;
  // {"width", "height", "can_halve", "height_range_m", "mean": {plane: mean}, "azimuths_ao",
  // "azimuths_light", "seeds_light", "bounces", "error": {plane: rms}, "best_run_error": {plane: rms of the
  // highest rung, the reference's own error taken out}, "cpu_seconds", "referee": [{"quantity", "reference",
  // "referee", "bias", "half_width", "texels"}]}. error is rms(A − B)/2 of two groups of seeds: the standard
  // error of their mean, without what both have in common. That is what the referee, an unbiased path tracer
  // on a sample of texels, is for.
  nlohmann::ordered_json facts;
};

Reference make_reference(const Surface& surface, const ReferenceOptions& options);

}  // namespace hemibake
