#include "trade/analysis.h"

#include <algorithm>
#include <string_view>

namespace hemibake {
namespace {

constexpr std::string_view kFrontModel = "bounded";

// Returns whether a run is judged by this plane. A run with bounces pays for them; its α and E₀/π are those
// of the run without, which is in the study too.
bool is_judged_by(const ScoredRun& run, size_t plane) {
  return run.error[plane] && !(plane < kFirstPlane && run.has_bounces());
}

}  // namespace

std::vector<FrontPoint> front_of(std::span<const ScoredRun> runs, size_t plane) {
  std::vector<FrontPoint> points;
  for (const ScoredRun& run : runs) {
    if (run.known < 1) continue;
    if (is_judged_by(run, plane))
      points.push_back({run.id(), "", {run.cost.cpu_seconds, run.error[plane]->rmse}});
    if (plane < kLightPlanes || run.has_bounces()) continue;
    for (const LightModelErrors& model : run.models)
      if (model.model == kFrontModel)
        points.push_back(
            {run.id(), model.model, {run.cost.cpu_seconds, model.error[plane - kLightPlanes].rmse}});
  }
  std::vector<CostAndError> values;
  for (const FrontPoint& point : points) values.push_back(point.value);
  std::vector<FrontPoint> front;
  for (const size_t i : pareto_front(values)) front.push_back(points[i]);
  return front;
}

std::vector<Series> series_of(std::span<const ScoredRun> runs, size_t plane) {
  std::vector<Series> all;
  for (const ScoredRun& run : runs) {
    if (run.series.empty() || !is_judged_by(run, plane)) continue;
    auto series = std::ranges::find(all, run.series, &Series::name);
    if (series == all.end()) series = all.insert(all.end(), Series{run.series, run.abscissa_name, {}, {}});
    series->points.push_back({run.abscissa, run.error[plane]->rmse});
  }
  for (Series& series : all) {
    std::vector<double> x, y;
    for (const auto& [abscissa, error] : series.points) {
      x.push_back(abscissa);
      y.push_back(error);
    }
    series.law = fit_power_law(x, y);
  }
  return all;
}

std::array<PlanePrecision, kPlaneCount> precision_of(const PlaneValues& reference_error,
                                                     std::span<const ScoredRun> runs) {
  std::array<PlanePrecision, kPlaneCount> all;
  for (size_t p = 0; p < kPlaneCount; ++p) {
    PlanePrecision& precision = all[p];
    precision.error = reference_error[p];
    for (const ScoredRun& run : runs) {
      if (run.known < 1 || !run.error[p]) continue;
      const double alone = own_error(run.error[p]->rmse, precision.error);
      if (alone >= precision.best_error) continue;
      precision.best_error = alone;
      precision.best_run = &run;
    }
    precision.reached = precision.error <= std::max(kReferenceShare * precision.best_error, kRoundingError);
  }
  return all;
}

}  // namespace hemibake
