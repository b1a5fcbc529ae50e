#include "trade/scored_run.h"

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/parallel.h"
#include "trade/child_process.h"

namespace hemibake {
namespace {

constexpr double kShortSeconds = 0.1;
constexpr int kMostRepeats = 3;

double known_share(const RunPlanes& planes) {
  if (planes.known.empty()) return 1;
  const auto seen = std::ranges::count_if(planes.known.values, [](uint8_t known) { return known != 0; });
  return static_cast<double>(seen) / static_cast<double>(planes.known.size());
}

}  // namespace

MeasuredRun measure_run(const TradeRun& run, const Surface& surface, const Grid<float>& direct) {
  MeasuredRun best;
  const MemoryProbe probe;
  for (int repeat = 1; repeat <= kMostRepeats; ++repeat) {
    const auto wall_start = std::chrono::steady_clock::now();
    const double cpu_start = process_cpu_seconds();
    RunPlanes planes = run.perform(surface, direct);
    const double cpu_seconds = process_cpu_seconds() - cpu_start;
    const double wall_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
    if (repeat == 1) {
      best.cost.memory_bytes = probe.peak_growth_bytes();
      best.planes = std::move(planes);
    }
    if (repeat == 1 || cpu_seconds < best.cost.cpu_seconds) best.cost.cpu_seconds = cpu_seconds;
    if (repeat == 1 || wall_seconds < best.cost.wall_seconds) best.cost.wall_seconds = wall_seconds;
    best.cost.repeats = repeat;
    if (cpu_seconds > kShortSeconds) break;
  }
  return best;
}

PlaneErrors errors_of(const RunPlanes& planes, const RunPlanes& truth) {
  PlaneErrors errors;
  for (size_t p = 0; p < kPlaneCount; ++p) {
    const NamedPlane& named = named_planes()[p];
    const Grid<float>& plane = named.of(planes);
    if (!plane.empty()) errors[p] = error_of(plane.values, named.of(truth).values, planes.known.values);
  }
  return errors;
}

std::optional<CurveErrors> curve_errors_of(const RunPlanes& planes, const RunPlanes& truth) {
  const bool uniform = !planes.uniform.empty();
  const Grid<float>& ao = uniform ? planes.uniform : planes.cosine;
  if (ao.empty()) return std::nullopt;
  const Grid<float>& true_ao = uniform ? truth.uniform : truth.cosine;
  const auto error_with = [&](const Grid<float>& own, const Grid<float>& values) {
    return curve_error(ao.values, own.empty() ? values.values : own.values, true_ao.values, values.values,
                       planes.known.values);
  };
  // Where the run's only AO is E₀/π itself, its E₀ against it is a straight line: the truth takes its place.
  return CurveErrors{error_with(uniform ? planes.cosine : Grid<float>{}, truth.cosine),
                     error_with(planes.first_bounce, truth.first_bounce)};
}

ScoredRun score_run(const TradeRun& run, const MeasuredRun& measured, const FittedModels& fitted,
                    const RunPlanes& truth) {
  const RunPlanes& planes = measured.planes;
  ScoredRun scored;
  static_cast<RunDescription&>(scored) = run;
  scored.cost = measured.cost;
  scored.work = planes.work;
  scored.known = known_share(planes);
  scored.error = errors_of(planes, truth);
  scored.curve = curve_errors_of(planes, truth);
  scored.models = light_model_errors(planes, fitted, truth);
  return scored;
}

}  // namespace hemibake
