// Fronts, convergence and precision of a study's runs.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "trade/pareto_front.h"
#include "trade/reference.h"
#include "trade/scored_run.h"

namespace hemibake {

// Planes that have fronts and series.
inline constexpr std::array<size_t, 3> kFrontPlanes = {kAoPlane, kDirectPlane, kLightPlanes + 1};

struct FrontPoint {
  std::string id;
  std::string model;  // that made E/π of the run's AO; empty: the run itself did
  CostAndError value;
};

// Returns the Pareto front, cheapest first. For E/π, runs with an AO only take part by way of the bounded
// model. Runs that leave texels out take no part.
std::vector<FrontPoint> front_of(std::span<const ScoredRun> runs, size_t plane);

// Error of runs that differ in one setting only.
struct Series {
  std::string name, abscissa_name;
  std::vector<std::pair<double, double>> points;  // abscissa, rms error
  PowerLaw law;
};

std::vector<Series> series_of(std::span<const ScoredRun> runs, size_t plane);

// Error of the reference on one plane against that of the best of all runs.
struct PlanePrecision {
  double error = 0;
  const ScoredRun* best_run = nullptr;  // null: no run gives the whole plane with an error
  double best_error = HUGE_VAL;         // without the reference's own
  bool reached = false;                 // error is at most kReferenceShare of best_error, or rounding
};

// The runs must outlive the result.
std::array<PlanePrecision, kPlaneCount> precision_of(const PlaneValues& reference_error,
                                                     std::span<const ScoredRun> runs);

}  // namespace hemibake
