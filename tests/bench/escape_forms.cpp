#include "bench/escape_forms.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "model/closed_forms.h"

namespace hemibake {
namespace {

using Escape = std::function<double(const TexelInput&, const double*)>;

constexpr double kTiny = 1e-6;  // where a fit on its way leaves the range of a form

Form escape_form(std::string inputs, std::string formula, std::vector<double> start, Escape escape) {
  return {std::move(inputs), std::move(formula), std::move(start),
          [escape = std::move(escape)](const TexelInput& t, double albedo, const double* c) {
            return escape_irradiance(t.visibility, std::clamp(escape(t, c), kTiny, 1.0), albedo);
          }};
}

double bounded_total(const TexelInput& t, double albedo, const double* c) {
  const double k0 = std::clamp(c[0], -1.0, 1.0), k1 = std::clamp(c[1], -1.0, 1.0);
  const double direct = bounded_direct_factor(t.escape, k0, k1);
  const double blocked = bounded_blocked_factor(t.escape, k0, k1);
  const double escape = bounded_escape_share(direct, c[2] * (1 - std::clamp(c[3], 0.0, 0.9999)), c[2]);
  return total_factor(direct, blocked, std::clamp(escape, kTiny, 1.0), albedo);
}

std::vector<Form> forms_without_escape_share() {
  std::vector<Form> list;
  list.push_back({"V", "E = V", {}, [](const TexelInput& t, double, const double*) { return t.visibility; }});
  list.push_back({"V", "cubic of Jimenez 2016", {}, [](const TexelInput& t, double albedo, const double*) {
                    const double cubic = jimenez_cubic(t.visibility, albedo, kJimenezConstants.data());
                    return std::max(t.visibility, cubic);
                  }});
  list.push_back({"α", "bounded model", {0.42, 1, 0.46, 0.99}, bounded_total});
  return list;
}

using T = const TexelInput&;
using C = const double*;

std::vector<Form> forms_of_visibility() {
  std::vector<Form> list;
  const auto add = [&](const char* inputs, const char* formula, std::vector<double> start, Escape escape) {
    list.push_back(escape_form(inputs, formula, std::move(start), std::move(escape)));
  };
  add("V", "V", {}, [](T t, C) { return t.visibility; });
  add("V", "a + bV", {0.03, 0.8}, [](T t, C c) { return c[0] + c[1] * t.visibility; });
  add("V", "aV/(b + V)", {1.3, 0.5}, [](T t, C c) { return c[0] * t.visibility / (c[1] + t.visibility); });
  add("V", "V(a + bV + cV²)", {0.8, 0, 0},
      [](T t, C c) { return t.visibility * (c[0] + t.visibility * (c[1] + t.visibility * c[2])); });
  add("V, n.z", "a + bV + c n.z", {0.07, 0.86, -0.1},
      [](T t, C c) { return c[0] + c[1] * t.visibility + c[2] * t.normal_z; });
  add("V, n.z", "V(a + b n.z)", {1, -0.1},
      [](T t, C c) { return t.visibility * (c[0] + c[1] * t.normal_z); });
  add("V, n.z", "V(1.3 − .6 n.z)", {}, [](T t, C) { return t.visibility * (1.3 - 0.6 * t.normal_z); });
  add("V, m", "V(1 + m)/(1 + V)", {},
      [](T t, C) { return t.visibility * (1 + t.map_escape) / (1 + t.visibility); });
  add("V, m", "(a + bm)V/(c + V)", {0.25, 1, 0.4},
      [](T t, C c) { return (c[0] + c[1] * t.map_escape) * t.visibility / (c[2] + t.visibility); });
  add("V, m", "a m^b V^c", {1, 0.6, 0.6}, [](T t, C c) {
    return c[0] * std::pow(t.map_escape, c[1]) * std::pow(std::max(t.visibility, kTiny), c[2]);
  });
  add("V, n.z, m", "V(a + bm + c n.z)", {1, 0.3, -0.5},
      [](T t, C c) { return t.visibility * (c[0] + c[1] * t.map_escape + c[2] * t.normal_z); });
  return list;
}

std::vector<Form> forms_of_both() {
  std::vector<Form> list;
  const auto add = [&](const char* inputs, const char* formula, std::vector<double> start, Escape escape) {
    list.push_back(escape_form(inputs, formula, std::move(start), std::move(escape)));
  };
  add("V, α", "α", {}, [](T t, C) { return t.escape; });
  add("V, α", "√(αV)", {}, [](T t, C) { return std::sqrt(t.escape * t.visibility); });
  add("V, α", "a + bα", {0, 1}, [](T t, C c) { return c[0] + c[1] * t.escape; });
  add("V, α", "a + bα + cV", {0, 1, 0},
      [](T t, C c) { return c[0] + c[1] * t.escape + c[2] * t.visibility; });
  add("V, α", "aα/(b + α)", {2, 1}, [](T t, C c) { return c[0] * t.escape / (c[1] + t.escape); });
  add("V, α", "α(a + bα + cV)", {1, 0, 0},
      [](T t, C c) { return t.escape * (c[0] + c[1] * t.escape + c[2] * t.visibility); });
  add("V, α", "aα + bα²/V", {1, 0},
      [](T t, C c) { return c[0] * t.escape + c[1] * t.escape * t.escape / std::max(t.visibility, kTiny); });
  add("V, α, n.z", "α(a + b n.z + cα)", {1, 0, 0},
      [](T t, C c) { return t.escape * (c[0] + c[1] * t.normal_z + c[2] * t.escape); });
  add("V, α, m", "α(1 + m − α)", {}, [](T t, C) { return t.escape * (1 + t.map_escape - t.escape); });
  add("V, α, m", "α(1 + m)/(1 + α)", {},
      [](T t, C) { return t.escape * (1 + t.map_escape) / (1 + t.escape); });
  add("V, α, m", "α(1 + 2m)/(1 + 2α)", {},
      [](T t, C) { return t.escape * (1 + 2 * t.map_escape) / (1 + 2 * t.escape); });
  add("V, α, m", "α(a + bm − cα)", {0.85, 1.12, 0.86},
      [](T t, C c) { return t.escape * (c[0] + c[1] * t.map_escape - c[2] * t.escape); });
  add("V, α, m", "α(a + bm)/(c + α)", {1, 1, 0.7},
      [](T t, C c) { return t.escape * (c[0] + c[1] * t.map_escape) / (c[2] + t.escape); });
  add("V, α, m", "a m^b α^c", {1, 0.5, 0.7}, [](T t, C c) {
    return c[0] * std::pow(t.map_escape, c[1]) * std::pow(std::max(t.escape, kTiny), c[2]);
  });
  return list;
}

TexelInput input_of(const MapTruth& map, size_t i, double m) {
  return {map.visibility[i], map.escape[i], map.normal_z[i], m};
}

// One equation of the fit: a texel at an albedo.
struct Sample {
  TexelInput texel;
  double albedo, truth;
  size_t group;  // of a map and albedo
};

std::vector<Sample> draw_samples(std::span<const MapTruth* const> maps) {
  constexpr size_t kTexels = 1000;
  std::vector<Sample> samples;
  for (size_t k = 0; k < maps.size(); ++k) {
    const MapTruth& map = *maps[k];
    const double m = map_escape(map);
    // A step that shares no factor with the sides.
    const size_t step = std::max<size_t>(1, map.size() / kTexels) | 1;
    for (size_t i = step / 2; i < map.size(); i += step)
      for (size_t a = 0; a < kModelAlbedos; ++a)
        samples.push_back(
            {input_of(map, i, m), kTruthAlbedos[a], map.irradiance[a][i], k * kModelAlbedos + a});
  }
  return samples;
}

// Returns the mean square error of every group.
std::vector<double> group_errors(const Form& form, const double* c, const std::vector<Sample>& samples) {
  std::vector<double> sums(samples.back().group + 1), counts(sums.size());
  for (const Sample& s : samples) {
    const double error = form.total(s.texel, s.albedo, c) - s.truth;
    sums[s.group] += error * error;
    counts[s.group] += 1;
  }
  for (size_t g = 0; g < sums.size(); ++g) sums[g] /= counts[g];
  return sums;
}

double sum_of_roots(const std::vector<double>& squares) {
  return std::accumulate(squares.begin(), squares.end(), 0.0,
                         [](double sum, double square) { return sum + std::sqrt(square); });
}

// Adds up the normal equations of a Gauss-Newton step.
void normal_equations(const Form& form, const Eigen::VectorXd& c, const std::vector<Sample>& samples,
                      const std::vector<double>& weights, Eigen::MatrixXd& square, Eigen::VectorXd& right) {
  constexpr double kStep = 1e-5;
  const Eigen::Index count = c.size();
  square.setZero(count, count), right.setZero(count);
  Eigen::VectorXd moved = c, gradient(count);
  for (const Sample& s : samples) {
    const double value = form.total(s.texel, s.albedo, c.data());
    for (Eigen::Index p = 0; p < count; ++p) {
      moved[p] = c[p] + kStep;
      gradient[p] = (form.total(s.texel, s.albedo, moved.data()) - value) / kStep;
      moved[p] = c[p];
    }
    square += weights[s.group] * gradient * gradient.transpose();
    right -= weights[s.group] * (value - s.truth) * gradient;
  }
}

}  // namespace

std::vector<Form> forms() {
  std::vector<Form> list = forms_without_escape_share();
  for (auto* more : {forms_of_visibility, forms_of_both})
    for (Form& form : more()) list.push_back(std::move(form));
  return list;
}

double map_escape(const MapTruth& map) {
  double sum = 0, squares = 0;
  for (const float v : map.visibility.values) sum += v, squares += double{v} * v;
  const double count = static_cast<double>(map.size());
  return sum < count ? (sum - squares) / (count - sum) : 1;
}

AlbedoErrors errors_of(const Form& form, std::span<const double> constants, const MapTruth& map) {
  const double m = map_escape(map);
  AlbedoErrors errors{};
  for (size_t a = 0; a < kModelAlbedos; ++a) {
    for (size_t i = 0; i < map.size(); ++i) {
      const double error =
          form.total(input_of(map, i, m), kTruthAlbedos[a], constants.data()) - map.irradiance[a][i];
      errors[a] += error * error;
    }
    errors[a] = std::sqrt(errors[a] / static_cast<double>(map.size()));
  }
  return errors;
}

double mean_of(const AlbedoErrors& errors) {
  return std::accumulate(errors.begin(), errors.end(), 0.0) / errors.size();
}

std::vector<double> fit(const Form& form, std::span<const MapTruth* const> maps) {
  if (form.constants.empty()) return {};
  constexpr int kSteps = 25;
  const std::vector<Sample> samples = draw_samples(maps);
  Eigen::VectorXd c = Eigen::Map<const Eigen::VectorXd>(form.constants.data(),
                                                        static_cast<Eigen::Index>(form.constants.size()));
  std::vector<double> errors = group_errors(form, c.data(), samples);
  double damping = 1e-4;
  for (int step = 0; step < kSteps && damping < 1e3; ++step) {
    std::vector<double> weights(errors.size());
    std::ranges::transform(errors, weights.begin(), [](double e) { return 1 / std::sqrt(e + 1e-8); });
    Eigen::MatrixXd square;
    Eigen::VectorXd right;
    normal_equations(form, c, samples, weights, square, right);
    square.diagonal() *= 1 + damping;
    square.diagonal().array() += 1e-9;
    const Eigen::VectorXd next = c + square.ldlt().solve(right);
    const std::vector<double> next_errors = group_errors(form, next.data(), samples);
    const double before = sum_of_roots(errors), after = sum_of_roots(next_errors);
    if (!(after < before)) {
      damping *= 10;
      continue;
    }
    c = next, errors = next_errors, damping *= 0.3;
    if (before - after < 1e-6 * before) break;
  }
  return {c.data(), c.data() + c.size()};
}

}  // namespace hemibake
