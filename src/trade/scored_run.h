// One run, measured and compared with the truth.
#pragma once

#include <nlohmann/json.hpp>

#include "trade/light_models.h"
#include "trade/trade_run.h"

namespace hemibake {

// What a run costs.
struct RunCost {
  double cpu_seconds = 0;   // of this process on all threads, from the surface to the planes
  double wall_seconds = 0;  // the same; other work on the machine shows
  int repeats = 1;          // runs below a tenth of a second are repeated, and the fastest counts
  // Largest resident memory while it ran (first repeat) over that before: its own structures and planes, not
  // the program, the map or the truth. A process of its own, see trade/child_process.h.
  size_t memory_bytes = 0;
};

struct MeasuredRun {
  RunPlanes planes;
  RunCost cost;
};

MeasuredRun measure_run(const TradeRun& run, const Surface& surface, const Grid<float>& direct);

// {plane: {"rmse", "bias", "max", "p99"}} of every plane the run has.
nlohmann::ordered_json errors_of(const RunPlanes& planes, const RunPlanes& truth);

// {"E0": {"bias", "rms", "max", "bins"}, "E1": …}: the curves the run would give (α, or E₀/π where it has no
// α, against E_b/π; true values where it has none of its own).
nlohmann::ordered_json curve_errors_of(const RunPlanes& planes, const RunPlanes& truth);

// {model: {"light.20": {"rmse", …}, …}, …}
nlohmann::ordered_json model_errors_of(const RunPlanes& planes, const FittedModels& fitted,
                                       const RunPlanes& truth);

// All of it, as trade.json holds it (trade/trade_file.h).
nlohmann::ordered_json score_run(const TradeRun& run, const MeasuredRun& measured, const FittedModels& fitted,
                                 const RunPlanes& truth);

}  // namespace hemibake
