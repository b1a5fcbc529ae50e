#include "fitting/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/constants.h"
#include "core/error.h"

namespace hemibake {
namespace {

// Smallest standard error of a bin's mean of E/π that is believed. A bin of flat ground has no spread at all,
// and would outweigh every other without limit; the rays of a bake leave about this much.
constexpr double kSmallestStandardError = 1e-4;

double raw_weight(const CurveBin& bin, double stddev_over_pi, Weights weights) {
  switch (weights) {
    case Weights::none:
      return 1;
    case Weights::count:
      return bin.count;
    case Weights::standard_error:
      return 1 / std::max(stddev_over_pi * stddev_over_pi / bin.count,
                          kSmallestStandardError * kSmallestStandardError);
  }
  throw std::logic_error("weights of an unknown kind");
}

}  // namespace

std::vector<CurvePoint> curve_points(const Curves& curves, int bounce, Abscissa abscissa, Weights weights) {
  if (weights != Weights::none && !curves.has_counts) {
    throw InputError(fmt::format(
        "curves without counts, expected columns count and E00_stddev for --weights {}", to_string(weights)));
  }
  if (abscissa == Abscissa::published && curves.bins.size() < 2) {
    throw InputError("1 bin, expected at least 2 for --abscissa published");
  }
  std::vector<CurvePoint> points;
  double weight_sum = 0;
  const double last = static_cast<double>(curves.bins.size()) - 1;
  for (size_t j = 0; j < curves.bins.size(); ++j) {
    const CurveBin& bin = curves.bins[j];
    if (bin.count < (weights == Weights::standard_error ? 2 : 1)) continue;
    const BounceStatistics& statistics = bin.bounces.at(static_cast<size_t>(bounce));
    const double ao = abscissa == Abscissa::center ? bin_center(bin) : static_cast<double>(j + 1) / last;
    points.push_back({ao, statistics.mean / kPi, raw_weight(bin, statistics.stddev / kPi, weights)});
    weight_sum += points.back().weight;
  }
  for (CurvePoint& point : points) point.weight *= static_cast<double>(points.size()) / weight_sum;
  return points;
}

double parameter_value(const Fit& fit, const std::string& name) {
  for (const FitParameter& parameter : fit.parameters) {
    if (parameter.name == name) return parameter.value;
  }
  throw std::logic_error(fmt::format("fit of {} has no parameter {}", fit.model, name));
}

std::string to_string(Abscissa abscissa) { return abscissa == Abscissa::center ? "center" : "published"; }

std::string to_string(Weights weights) {
  switch (weights) {
    case Weights::none:
      return "none";
    case Weights::count:
      return "count";
    case Weights::standard_error:
      return "stderr";
  }
  throw std::logic_error("weights of an unknown kind");
}

}  // namespace hemibake
