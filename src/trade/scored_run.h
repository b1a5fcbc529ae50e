// One run, measured and compared with the truth.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "trade/errors.h"
#include "trade/light_models.h"
#include "trade/trade_run.h"

namespace hemibake {

struct RunCost {
  double cpu_seconds = 0;   // of this process on all threads, from the surface to the planes
  double wall_seconds = 0;  // likewise; other work on the machine shows
  int repeats = 1;          // runs below a tenth of a second are repeated, and the fastest counts
  // Largest resident memory while it ran (first repeat) over that before: its own structures and planes, not
  // the program, the map or the truth. Needs a process of its own (trade/child_process.h).
  size_t memory_bytes = 0;
};

struct MeasuredRun {
  RunPlanes planes;
  RunCost cost;
};

// Performs the run and measures it. direct: the true E₀, 0..π.
MeasuredRun measure_run(const TradeRun& run, const Surface& surface, const Grid<float>& direct);

// One error per plane of named_planes(); none where the run lacks the plane.
using PlaneErrors = std::array<std::optional<ErrorStatistics>, kPlaneCount>;

// Returns the errors of run − truth over the texels the run knows.
PlaneErrors errors_of(const RunPlanes& planes, const RunPlanes& truth);

// Errors of the curves a run gives: E₀/π and E₁/π against α, or against E₀/π where it has no α.
using CurveErrors = std::array<CurveError, 2>;

// Returns none for a run without AO. True values stand in for planes the run lacks.
std::optional<CurveErrors> curve_errors_of(const RunPlanes& planes, const RunPlanes& truth);

struct ScoredRun : RunDescription {
  RunCost cost;
  uint64_t work = 0;  // RunPlanes::work
  double known = 1;   // share of the texels the method has an answer for
  PlaneErrors error;
  std::optional<CurveErrors> curve;
  std::vector<LightModelErrors> models;

  // Returns whether it traced bounces itself.
  bool has_bounces() const { return error[kFirstPlane].has_value(); }
};

ScoredRun score_run(const TradeRun& run, const MeasuredRun& measured, const FittedModels& fitted,
                    const RunPlanes& truth);

}  // namespace hemibake
