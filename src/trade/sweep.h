// The parameter sweep of a study: every tracer and estimator at levels of its settings.
#pragma once

#include <string>
#include <vector>

#include "trade/trade_run.h"

namespace hemibake {

// Number of levels: seconds, minutes and an hour on a map of 128².
enum class Effort { kQuick, kNormal, kFull };

// Number of bounces of a run that does not vary them.
inline constexpr int kTradeBounces = 40;

// Return the slice tracer's azimuths on the highest level, for AO and for all bounces. The reference uses
// more.
int top_ao_azimuths(Effort effort);
int top_light_azimuths(Effort effort);

// Returns all runs. can_halve: the map can be baked at half its resolution (trade/resample.h).
std::vector<TradeRun> make_sweep(Effort effort, bool can_halve);

// Adds the tracers: rays with Embree spread both ways, slices, the march of 2018, rays cut short at a
// distance; links for bounces with facets and texels, number of bounces, resolution.
void add_tracer_runs(Effort effort, bool can_halve, std::vector<TradeRun>& runs);
// Adds the estimators: disks, screen space, horizons; light between disks.
void add_estimator_runs(Effort effort, std::vector<TradeRun>& runs);

// Returns the levels from low to high by factors of 4, with kFull of 2; with kQuick low and quick_high only.
std::vector<int> sweep_levels(Effort effort, int low, int high, int quick_high);

}  // namespace hemibake
