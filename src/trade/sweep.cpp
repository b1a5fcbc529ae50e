#include "trade/sweep.h"

namespace hemibake {

int top_ao_azimuths(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return 16;
    case Effort::kNormal:
      return 128;
    default:
      return 256;
  }
}

int top_light_azimuths(Effort effort) { return effort == Effort::kQuick ? 8 : 64; }

std::vector<int> sweep_levels(Effort effort, int low, int high, int quick_high) {
  if (effort == Effort::kQuick)
    return low == quick_high ? std::vector<int>{low} : std::vector<int>{low, quick_high};
  std::vector<int> result;
  for (int level = low; level <= high; level *= effort == Effort::kFull ? 2 : 4) result.push_back(level);
  if (result.back() != high) result.push_back(high);
  return result;
}

std::vector<TradeRun> make_sweep(Effort effort, bool can_halve) {
  std::vector<TradeRun> runs;
  add_tracer_runs(effort, can_halve, runs);
  add_estimator_runs(effort, runs);
  return runs;
}

}  // namespace hemibake
