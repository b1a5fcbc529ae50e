// Fits at their bounds: the minimum is the same from every start, meets the conditions of Karush, Kuhn and
// Tucker, and is that of a solver that shares no code with it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "core/constants.h"
#include "fitting/bounded.h"
#include "fitting/mayaux2018.h"
#include "fitting/visibility.h"
#include "io/curves_file.h"

namespace hemibake {
namespace {

using Pair = std::array<double, 2>;
using Cost = std::function<double(const Pair&)>;

constexpr int kStarts = 8;
constexpr double kSame = 1e-6;  // in the parameters, which are about 1

std::vector<CurvePoint> direct_points(const Curves& curves) {
  return curve_points(curves, 0, Abscissa::kCenter, Weights::kNone);
}

std::vector<CurvePoint> totals(const Curves& curves, Abscissa abscissa = Abscissa::kCenter) {
  return total_points(curves, fit_albedos(), abscissa, Weights::kNone);
}

int albedo_count() { return static_cast<int>(fit_albedos().size()); }

Curves stored_curves(const std::string& name) {
  return read_curves(fmt::format("{}/fits/curves/{}.csv", HEMIBAKE_SOURCE_DIR, name));
}

std::vector<std::pair<std::string, Curves>> all_curves() {
  std::vector<std::pair<std::string, Curves>> sets;
  std::vector<Curves> pool;
  for (const char* name : {"bricks", "shapes", "concrete", "noise"}) {
    sets.emplace_back(name, stored_curves(name));
    pool.push_back(sets.back().second);
  }
  sets.emplace_back("all_maps", pool_curves(pool));
  return sets;
}

// Makes 40 bins of light at random, within 0..1 but of no surface: many of their fits end on bounds.
Curves random_curves(uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  const double bend = 2 * uniform(random) - 1, escape = uniform(random), noise = 0.1 * uniform(random);
  Curves curves;
  curves.bounce_count = 12;
  for (int j = 0; j < 40; ++j) {
    CurveBin bin{j / 40.0, (j + 1) / 40.0, (j + 0.5) / 40, 10, {}};
    const double ao = bin_center(bin);
    double v = ao * (1 + (1 - ao) * 1.3 * bend) + noise * (uniform(random) - 0.5);
    v = std::clamp(v, 0.001, 0.999);
    const double g = std::clamp(escape * (0.2 + 1.6 * ao * uniform(random)), 0.02, 1.0);
    bin.bounces.push_back({kPi * v, 0});
    for (int b = 1; b < 12; ++b) bin.bounces.push_back({kPi * (1 - v) * g * std::pow(1 - g, b - 1), 0});
    curves.bins.push_back(bin);
  }
  return curves;
}

// A model of two bounded parameters, and its cost written down again.
struct BoundedCase {
  std::string name;
  Pair low, high;
  std::function<Fit(const Starts&)> fit;
  Cost cost;
};

double open_total(double v, double g, double rho) { return v + (1 - v) * rho * g / (1 - rho + rho * g); }

Cost sum_over(std::vector<CurvePoint> points, std::function<double(const Pair&, const CurvePoint&)> value) {
  return [=](const Pair& p) {
    double sum = 0;
    for (const CurvePoint& point : points) sum += std::pow(value(p, point) - point.value, 2);
    return sum;
  };
}

double bounded_f0(double a, double k0, double k1) { return a + a * (1 - a) * (k0 + (k1 - k0) * a * a); }

std::vector<BoundedCase> cases_of(const Curves& curves) {
  const auto direct = direct_points(curves), center = totals(curves),
             at_v = totals(curves, Abscissa::kVisibility);
  const Fit f0 = fit_bounded_direct(direct);
  const double k0 = parameter_value(f0, "k0"), k1 = parameter_value(f0, "k1");
  return {
      {"bounded_F0",
       {-1, -1},
       {1, 1},
       [=](const Starts& starts) { return fit_bounded_direct(direct, starts); },
       sum_over(direct, [](const Pair& p, const CurvePoint& at) { return bounded_f0(at.ao, p[0], p[1]); })},
      {"bounded_tau",
       {0.001, 0},
       {1, 0.999},
       [=](const Starts& starts) { return fit_bounded_tau(center, albedo_count(), f0, starts); },
       sum_over(center,
                [=](const Pair& p, const CurvePoint& at) {
                  const double f = bounded_f0(at.ao, k0, k1);
                  return open_total(f, p[0] * (1 - p[1] * (1 - f) / (1 + 3 * f)), at.albedo);
                })},
      {"visibility",
       {0, 0},
       {1, 1},
       [=](const Starts& starts) { return fit_visibility(at_v, albedo_count(), starts); },
       sum_over(at_v,
                [](const Pair& p, const CurvePoint& at) {
                  return open_total(at.ao, p[0] * (1 - at.ao) + p[1] * at.ao, at.albedo);
                })},
      {"visibility_ao",
       {0, 0},
       {1, 1},
       [=](const Starts& starts) { return fit_visibility_ao(center, albedo_count(), starts); },
       sum_over(center, [](const Pair& p, const CurvePoint& at) {
         return open_total(at.visibility, p[0] * (1 - at.ao) + p[1] * at.ao, at.albedo);
       })}};
}

// Returns the minimum within the box by a grid that shrinks about its best point: no gradient, no bound held.
Pair minimum_by_grid(const BoundedCase& problem) {
  constexpr int kSteps = 10;
  constexpr double kShrink = 0.6;  // slow enough for a narrow valley that is not along an axis
  Pair center, half;
  for (size_t i = 0; i < 2; ++i) {
    center[i] = 0.5 * (problem.low[i] + problem.high[i]);
    half[i] = 0.5 * (problem.high[i] - problem.low[i]);
  }
  for (; half[0] > 1e-8; half[0] *= kShrink, half[1] *= kShrink) {
    Pair best = center;
    double least = problem.cost(center);
    for (int x = -kSteps; x <= kSteps; ++x) {
      for (int y = -kSteps; y <= kSteps; ++y) {
        const Pair at{std::clamp(center[0] + half[0] * x / kSteps, problem.low[0], problem.high[0]),
                      std::clamp(center[1] + half[1] * y / kSteps, problem.low[1], problem.high[1])};
        const double cost = problem.cost(at);
        if (cost >= least) continue;
        least = cost;
        best = at;
      }
    }
    center = best;
  }
  return center;
}

// Returns starts inside the box, on its sides and in its corners.
std::vector<std::vector<double>> spread_starts(const BoundedCase& problem, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-0.3, 1.3);
  std::vector<std::vector<double>> starts;
  for (int s = 0; s < kStarts; ++s) {
    std::vector<double> start;
    for (size_t i = 0; i < 2; ++i)
      start.push_back(problem.low[i] +
                      (problem.high[i] - problem.low[i]) * std::clamp(uniform(random), 0.0, 1.0));
    starts.push_back(start);
  }
  return starts;
}

void expect_one_minimum(const std::string& name, const Curves& curves) {
  for (const BoundedCase& problem : cases_of(curves)) {
    SCOPED_TRACE(name + " " + problem.name);
    const Fit fit = problem.fit({});
    for (const std::vector<double>& start : spread_starts(problem, 5)) {
      const Fit other = problem.fit({start});
      for (size_t i = 0; i < 2; ++i)
        EXPECT_NEAR(other.parameters[i].value, fit.parameters[i].value, kSame)
            << fit.parameters[i].name << " from " << start[0] << ", " << start[1];
    }
    const Pair found{fit.parameters[0].value, fit.parameters[1].value};
    EXPECT_LE(problem.cost(found), problem.cost(minimum_by_grid(problem)) * (1 + 1e-12) + 1e-20);
    for (size_t i = 0; i < 2; ++i) {
      const bool on_bound = found[i] == problem.low[i] || found[i] == problem.high[i];
      EXPECT_EQ(fit.parameters[i].on_bound, on_bound);
      EXPECT_EQ(fit.parameters[i].standard_error.has_value(), !on_bound);
      // The cost rises away from the minimum, wherever that is within the box.
      for (const double step : {-1e-4, 1e-4}) {
        Pair beside = found;
        beside[i] = std::clamp(found[i] + step, problem.low[i], problem.high[i]);
        EXPECT_GE(problem.cost(beside), problem.cost(found)) << i << " " << step;
      }
    }
  }
}

TEST(BoundedMinimum, StoredCurvesHaveOneFromEveryStart) {
  for (const auto& [name, curves] : all_curves()) expect_one_minimum(name, curves);
}

TEST(BoundedMinimum, RandomCurvesHaveOneFromEveryStart) {
  for (uint64_t seed = 0; seed < 12; ++seed)
    expect_one_minimum(fmt::format("random {}", seed), random_curves(seed));
}

// By golden sections in one parameter with the other on its bound, from the curves of version 0.1.0.
TEST(BoundedMinimum, KnownMinimaOfTheCurvesOfTheFirstVersion) {
  const auto k0 = [](const Curves& curves) {
    return parameter_value(fit_bounded_direct(direct_points(curves)), "k0");
  };
  const auto q = [](const Curves& curves, const Fit& direct) {
    return parameter_value(fit_bounded_tau(totals(curves), albedo_count(), direct), "q");
  };
  const auto first_version = [](const std::string& name) {
    return read_curves(fmt::format("{}/tests/fitting/curves_0.1.0/{}.csv", HEMIBAKE_SOURCE_DIR, name));
  };
  const Curves shapes = first_version("shapes"), concrete = first_version("concrete");
  EXPECT_NEAR(k0(stored_curves("bricks")), 0.1098094, 1e-4);  // E0 has not changed since
  EXPECT_NEAR(k0(shapes), 0.3470655, 1e-4);
  EXPECT_NEAR(k0(all_curves().back().second), 0.4265, 1e-4);
  EXPECT_NEAR(q(concrete, fit_bounded_direct(direct_points(concrete))), 0.4709530, 1e-4);
  EXPECT_NEAR(q(shapes, fit_bounded_direct(direct_points(shapes))), 0.5148687, 1e-4);
  Fit short_of_it;  // the F0 at which Ceres alone stops
  short_of_it.parameters = {{"k0", 0.340479, {}, false}, {"k1", 1, {}, false}};
  EXPECT_NEAR(q(shapes, short_of_it), 0.5189962, 1e-4);
}

// Expects the same minimum from starts about the best: unbounded parameters, in units of their own size.
void expect_same_from(const std::function<Fit(const Starts&)>& fit, double spread) {
  const Fit best = fit({});
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(1 - spread, 1 + spread);
  for (int s = 0; s < kStarts; ++s) {
    std::vector<double> start;
    for (const FitParameter& parameter : best.parameters) start.push_back(parameter.value * uniform(random));
    const Fit other = fit({start});
    for (size_t i = 0; i < start.size(); ++i)
      EXPECT_NEAR(other.parameters[i].value, best.parameters[i].value,
                  kSame * std::max(1.0, std::abs(best.parameters[i].value)))
          << best.model << " " << best.parameters[i].name;
  }
}

TEST(BoundedMinimum, OtherModelsHaveOneFromEveryStart) {
  for (const auto& [name, curves] : all_curves()) {
    SCOPED_TRACE(name);
    const auto direct = direct_points(curves);
    const auto first = curve_points(curves, 1, Abscissa::kCenter, Weights::kNone);
    const auto at_v = totals(curves, Abscissa::kVisibility);
    expect_same_from([&](const Starts& starts) { return fit_direct(direct, starts); }, 0.7);
    expect_same_from([&](const Starts& starts) { return fit_first_bounce(first, starts); }, 0.7);
    expect_same_from([&](const Starts& starts) { return fit_bounce(first, 1, starts); }, 0.3);
    expect_same_from([&](const Starts& starts) { return fit_jimenez(at_v, albedo_count(), starts); }, 2);
  }
}

}  // namespace
}  // namespace hemibake
