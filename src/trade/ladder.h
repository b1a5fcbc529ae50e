// The runs of a study: every tracer and estimator at a ladder of settings.
#pragma once

#include <string>
#include <vector>

#include "trade/trade_run.h"

namespace hemibake {

// How many rungs: seconds, minutes and an hour on a map of 128².
enum class Effort { kQuick, kNormal, kFull };

// Bounces of a run that is not about bounces.
inline constexpr int kTradeBounces = 40;

// Azimuths of the slice tracer on the highest rung, of AO and of all bounces: what the reference has to
// exceed.
int top_ao_azimuths(Effort effort);
int top_light_azimuths(Effort effort);

// can_halve: whether the map can be baked at half its resolution (trade/resample.h).
std::vector<TradeRun> make_ladder(Effort effort, bool can_halve);

// Parts of it. Tracers: rays with Embree spread both ways, slices, the march of 2018, cut short at a
// distance; links for bounces with facets and texels, number of bounces, resolution.
void add_tracer_runs(Effort effort, bool can_halve, std::vector<TradeRun>& runs);
// Disks, screen space, horizons; light between disks.
void add_estimator_runs(Effort effort, std::vector<TradeRun>& runs);

// From low to high by factors of 4, with kFull of 2; with kQuick low and quick_high only.
std::vector<int> rungs(Effort effort, int low, int high, int quick_high);

}  // namespace hemibake
