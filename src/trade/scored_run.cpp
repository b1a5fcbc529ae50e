#include "trade/scored_run.h"

#include <algorithm>
#include <chrono>

#include "core/error.h"
#include "core/parallel.h"
#include "trade/child_process.h"
#include "trade/errors.h"

namespace hemibake {
namespace {

constexpr double kShortSeconds = 0.1;
constexpr int kMostRepeats = 3;

nlohmann::ordered_json json_of(const ErrorStatistics& error) {
  return {{"rmse", error.rmse}, {"bias", error.bias}, {"max", error.largest}, {"p99", error.p99}};
}

nlohmann::ordered_json json_of(const CurveError& error) {
  return {{"bias", error.bias}, {"rms", error.rms}, {"max", error.largest}, {"bins", error.bins}};
}

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

nlohmann::ordered_json errors_of(const RunPlanes& planes, const RunPlanes& truth) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::object();
  for (const NamedPlane& named : named_planes()) {
    const Grid<float>& plane = named.of(planes);
    if (plane.empty()) continue;
    errors[named.name] = json_of(error_of(plane.values, named.of(truth).values, planes.known.values));
  }
  return errors;
}

nlohmann::ordered_json curve_errors_of(const RunPlanes& planes, const RunPlanes& truth) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::object();
  const bool uniform = !planes.uniform.empty();
  const Grid<float>& ao = uniform ? planes.uniform : planes.cosine;
  if (ao.empty()) return errors;
  const Grid<float>& true_ao = uniform ? truth.uniform : truth.cosine;
  const auto error_with = [&](const Grid<float>& own, const Grid<float>& values) {
    return json_of(curve_error(ao.values, own.empty() ? values.values : own.values, true_ao.values,
                               values.values, planes.known.values));
  };
  // Where the run's only AO is E₀/π itself, its E₀ against it is a straight line: the truth takes its place.
  errors["E0"] = error_with(uniform ? planes.cosine : Grid<float>{}, truth.cosine);
  errors["E1"] = error_with(planes.first_bounce, truth.first_bounce);
  return errors;
}

nlohmann::ordered_json model_errors_of(const RunPlanes& planes, const FittedModels& fitted,
                                       const RunPlanes& truth) {
  nlohmann::ordered_json errors = nlohmann::ordered_json::object();
  for (const LightModelErrors& model : light_model_errors(planes, fitted, truth))
    for (const NamedPlane& named : named_planes())
      if (named.single == nullptr) errors[model.model][named.name] = json_of(model.error[named.albedo]);
  return errors;
}

nlohmann::ordered_json score_run(const TradeRun& run, const MeasuredRun& measured, const FittedModels& fitted,
                                 const RunPlanes& truth) {
  const RunPlanes& planes = measured.planes;
  return {{"id", run.id()},
          {"method", run.method},
          {"settings", run.settings},
          {"series", run.series},
          {"abscissa", run.abscissa_name},
          {"abscissa_value", run.abscissa},
          {"representative", run.representative},
          {"cpu_seconds", measured.cost.cpu_seconds},
          {"wall_seconds", measured.cost.wall_seconds},
          {"repeats", measured.cost.repeats},
          {"memory_bytes", measured.cost.memory_bytes},
          {"work", planes.work},
          {"known", known_share(planes)},
          {"error", errors_of(planes, truth)},
          {"curve", curve_errors_of(planes, truth)},
          {"models", model_errors_of(planes, fitted, truth)}};
}

}  // namespace hemibake
