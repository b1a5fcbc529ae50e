#include "curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "core/portable_math.h"
#include "core/statistics.h"
#include "transport/series.h"

namespace hemibake {
namespace {

// Distance of α from 0..1 that rounding in a tracer's sum of weights may leave (a few float ulps).
constexpr float kAoRounding = 1e-6F;

// Excess of V over 1 that the rays of 2018 have: 2·mean(cos θ) of a cone of 179° is 1.007758.
constexpr float kConeExcess = 0.01F;

// Mean 1 − V below which it is all rounding of floats.
constexpr double kFlatGround = 1e-6;

// Writes texel `i` of a grid as "(x, y)".
std::string texel_name(const Grid<float>& grid, size_t i) {
  const size_t width = static_cast<size_t>(grid.width);
  return fmt::format("({}, {})", i % width, i / width);
}

void check_irradiance(const Bake& bake, CurveIndex index) {
  if (bake.irradiance.empty())
    throw InputError(
        fmt::format("no channel irradiance.00, expected a bake with {}irradiance among its outputs",
                    index == CurveIndex::kAo ? "ao and " : ""));
  const size_t texels = bake.irradiance[0].size();
  for (size_t b = 0; b < bake.irradiance.size(); ++b) {
    const Grid<float>& irradiance = bake.irradiance[b];
    expect_equal(irradiance.size(), texels, "texels of an irradiance plane");
    for (size_t i = 0; i < irradiance.size(); ++i) {
      if ((irradiance[i] >= 0 && std::isfinite(irradiance[i])) || is_hole(bake, i)) continue;
      throw InputError(fmt::format("irradiance.{:02} at texel {} is {}, expected a finite number from 0", b,
                                   texel_name(irradiance, i), irradiance[i]));
    }
  }
}

// Returns the plane that sorts the texels, 0..1.
Grid<float> index_plane(const Bake& bake, CurveIndex index) {
  const bool is_ao = index == CurveIndex::kAo;
  Grid<float> plane = is_ao ? bake.visible_fraction : bake.visibility;
  if (is_ao && plane.empty())
    throw InputError("no channel ao, expected a bake with ao and irradiance among its outputs");
  check_irradiance(bake, index);
  if (plane.empty()) {
    plane = bake.irradiance[0];
    for (float& value : plane.values) value = static_cast<float>(value / kPi);
  }
  expect_equal(plane.size(), bake.irradiance[0].size(), "texels of an irradiance plane");
  const float highest = is_ao ? 1 + kAoRounding : 1 + kConeExcess;
  for (size_t i = 0; i < plane.size(); ++i) {
    if (is_hole(bake, i)) continue;
    if (!(plane[i] >= -kAoRounding && plane[i] <= highest))
      throw InputError(fmt::format("{} at texel {} is {}, expected 0 to 1", to_string(index),
                                   texel_name(plane, i), plane[i]));
    plane[i] = std::clamp(plane[i], 0.0F, 1.0F);
  }
  return plane;
}

}  // namespace

std::string to_string(CurveIndex index) { return index == CurveIndex::kAo ? "ao" : "visibility"; }

double bin_center(const CurveBin& bin) { return 0.5 * (bin.low + bin.high); }

double bin_visibility(const CurveBin& bin) { return bin.bounces.front().mean / kPi; }

std::optional<double> mean_escape(const Curves& curves) {
  if (!curves.has_counts || curves.bounce_count == 0) return std::nullopt;
  double count = 0, blocked = 0, seen_and_blocked = 0;  // sums of 1, 1 − V and V − V² over the texels
  for (const CurveBin& bin : curves.bins) {
    if (bin.count == 0) continue;
    const double v = std::min(bin_visibility(bin), 1.0), spread = bin.bounces[0].stddev / kPi;
    count += bin.count;
    blocked += bin.count * (1 - v);
    seen_and_blocked += bin.count * (v * (1 - v) - spread * spread);
  }
  if (blocked <= kFlatGround * count) return 1;
  return std::clamp(seen_and_blocked / blocked, 0.0, 1.0);
}

double total_over_pi(const CurveBin& bin, double albedo) {
  const size_t count = bin.bounces.size();
  const auto mean = [&](size_t b) { return bin.bounces[b].mean; };
  double total = sum_bounces(count, mean, albedo);
  if (count < 3 || mean(count - 1) >= mean(count - 2)) return total / kPi;
  // The energy not yet seen bounds the tail at albedo 1: the last two bounces of a slow bin do not tell it
  // well.
  const double last = mean(count - 1);
  const double tail = series_tail(mean(count - 2), last, 1, kPi - sum_bounces(count, mean, 1));
  const double ratio = tail / (tail + last);
  const double before = PortableMath<double>::pow(albedo, static_cast<double>(count - 2));
  if (tail > 0) total += series_tail(before * last / ratio, before * albedo * last, albedo);
  return total / kPi;
}

Curves make_curves(const Bake& bake, int bins, CurveIndex index) {
  const Grid<float> plane = index_plane(bake, index);
  std::vector<size_t> bin_of_texel(plane.size());
  std::vector<Moments> index_of_bin(static_cast<size_t>(bins));
  for (size_t i = 0; i < plane.size(); ++i) {
    if (is_hole(bake, i)) continue;
    const int bin = static_cast<int>(std::floor(bins * static_cast<double>(plane[i])));
    bin_of_texel[i] = static_cast<size_t>(std::min(bin, bins - 1));
    index_of_bin[bin_of_texel[i]].add(plane[i]);
  }

  Curves curves;
  curves.index = index;
  curves.bounce_count = static_cast<int>(bake.irradiance.size());
  curves.bins.resize(static_cast<size_t>(bins));
  for (size_t j = 0; j < curves.bins.size(); ++j) {
    CurveBin& bin = curves.bins[j];
    bin.low = static_cast<double>(j) / bins;
    bin.high = static_cast<double>(j + 1) / bins;
    bin.mean = index_of_bin[j].mean;
    bin.count = static_cast<double>(index_of_bin[j].count);
    bin.bounces.resize(bake.irradiance.size());
  }
  for (size_t b = 0; b < bake.irradiance.size(); ++b) {
    std::vector<Moments> moments(curves.bins.size());
    for (size_t i = 0; i < plane.size(); ++i)
      if (!is_hole(bake, i)) moments[bin_of_texel[i]].add(bake.irradiance[b][i]);
    for (size_t j = 0; j < curves.bins.size(); ++j) {
      curves.bins[j].bounces[b] = {moments[j].mean, moments[j].stddev()};
    }
  }
  return curves;
}

Curves pool_curves(std::span<const Curves> sets) {
  Curves pooled;
  pooled.index = sets[0].index;
  pooled.bounce_count = sets[0].bounce_count;
  for (const Curves& set : sets) {
    if (set.index != pooled.index)
      throw InputError("curves over ao and over visibility, expected all of them over the same");
    pooled.bounce_count = std::min(pooled.bounce_count, set.bounce_count);
    pooled.has_counts = pooled.has_counts && set.has_counts;
    pooled.bins.insert(pooled.bins.end(), set.bins.begin(), set.bins.end());
  }
  for (CurveBin& bin : pooled.bins) bin.bounces.resize(static_cast<size_t>(pooled.bounce_count));
  return pooled;
}

}  // namespace hemibake
