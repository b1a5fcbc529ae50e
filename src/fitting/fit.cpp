#include "fitting/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/constants.h"
#include "core/error.h"
#include "transport/series.h"

namespace hemibake {
namespace {

// Smallest standard error of a bin's mean of E/π: the noise of a bake's rays. Flat ground has no spread, and
// would outweigh every other bin without limit.
constexpr double kSmallestStandardError = 1e-4;

constexpr std::array kAbscissas = {std::pair{Abscissa::kCenter, "center"},
                                   std::pair{Abscissa::kMayaux2018, "published"},
                                   std::pair{Abscissa::kVisibility, "visibility"}};
constexpr std::array kWeights = {std::pair{Weights::kNone, "none"}, std::pair{Weights::kCount, "count"},
                                 std::pair{Weights::kStandardError, "stderr"}};

template <class Table, class Value>
std::string name_of(const Table& table, Value value) {
  for (const auto& [entry, name] : table) {
    if (entry == value) return name;
  }
  throw std::logic_error("a value without a name");
}

template <class Table>
auto value_of(const Table& table, const std::string& text) {
  std::string known;
  for (const auto& [entry, name] : table) {
    if (text == name) return entry;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw InputError(fmt::format("'{}', expected one of {}", text, known));
}

double raw_weight(double count, double stddev_over_pi, Weights weights) {
  switch (weights) {
    case Weights::kNone:
      return 1;
    case Weights::kCount:
      return count;
    case Weights::kStandardError:
      return 1 / std::max(stddev_over_pi * stddev_over_pi / count,
                          kSmallestStandardError * kSmallestStandardError);
  }
  throw std::logic_error("weights of an unknown kind");
}

// last: index of the last bin.
double position_of(const CurveBin& bin, size_t index, double last, Abscissa abscissa) {
  switch (abscissa) {
    case Abscissa::kCenter:
      return bin_center(bin);
    case Abscissa::kMayaux2018:
      return static_cast<double>(index + 1) / last;
    case Abscissa::kVisibility:
      return bin_visibility(bin);
  }
  throw std::logic_error("an abscissa of an unknown kind");
}

struct BinPosition {
  const CurveBin* bin;
  double ao;
};

std::vector<BinPosition> usable_bins(const Curves& curves, Abscissa abscissa, Weights weights) {
  if (weights != Weights::kNone && !curves.has_counts) {
    throw InputError(fmt::format(
        "curves without counts, expected columns count and E00_stddev for weights {}", to_string(weights)));
  }
  if (abscissa != Abscissa::kVisibility && curves.index != CurveIndex::kAo)
    throw InputError("curves over visibility, expected curves over ao");
  if (abscissa == Abscissa::kMayaux2018 && curves.bins.size() < 2) {
    throw InputError("1 bin, expected at least 2 for the published abscissa");
  }
  std::vector<BinPosition> usable;
  const double last = static_cast<double>(curves.bins.size()) - 1;
  for (size_t j = 0; j < curves.bins.size(); ++j) {
    const CurveBin& bin = curves.bins[j];
    if (bin.count < (weights == Weights::kStandardError ? 2 : 1)) continue;
    usable.push_back({&bin, position_of(bin, j, last, abscissa)});
  }
  return usable;
}

CurvePoint total_point(const CurveBin& bin, double abscissa, double albedo, Weights weights) {
  const double stddev = sum_bounces(
      bin.bounces.size(), [&](size_t b) { return bin.bounces[b].stddev; }, albedo);
  return {abscissa, total_over_pi(bin, albedo), raw_weight(bin.count, stddev / kPi, weights), albedo,
          bin_visibility(bin)};
}

void scale_to_mean_one(std::vector<CurvePoint>& points) {
  double sum = 0;
  for (const CurvePoint& point : points) sum += point.weight;
  for (CurvePoint& point : points) point.weight *= static_cast<double>(points.size()) / sum;
}

}  // namespace

std::vector<CurvePoint> curve_points(const Curves& curves, int bounce, Abscissa abscissa, Weights weights) {
  std::vector<CurvePoint> points;
  for (const auto& [bin, ao] : usable_bins(curves, abscissa, weights)) {
    const BounceStatistics& statistics = bin->bounces.at(static_cast<size_t>(bounce));
    points.push_back({ao, statistics.mean / kPi, raw_weight(bin->count, statistics.stddev / kPi, weights), 1,
                      bin_visibility(*bin)});
  }
  scale_to_mean_one(points);
  return points;
}

std::vector<CurvePoint> total_points(const Curves& curves, std::span<const double> albedos, Abscissa abscissa,
                                     Weights weights) {
  std::vector<CurvePoint> points;
  for (const auto& [bin, ao] : usable_bins(curves, abscissa, weights)) {
    for (const double albedo : albedos) points.push_back(total_point(*bin, ao, albedo, weights));
  }
  scale_to_mean_one(points);
  return points;
}

double parameter_value(const Fit& fit, const std::string& name) {
  for (const FitParameter& parameter : fit.parameters) {
    if (parameter.name == name) return parameter.value;
  }
  throw std::logic_error(fmt::format("fit of {} has no parameter {}", fit.model, name));
}

std::string to_string(Abscissa abscissa) { return name_of(kAbscissas, abscissa); }
std::string to_string(Weights weights) { return name_of(kWeights, weights); }
Abscissa abscissa_from_string(const std::string& text) { return value_of(kAbscissas, text); }
Weights weights_from_string(const std::string& text) { return value_of(kWeights, text); }

}  // namespace hemibake
