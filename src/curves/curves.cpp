#include "curves/curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/constants.h"
#include "core/error.h"
#include "core/statistics.h"
#include "transport/series.h"

namespace hemibake {
namespace {

// Distance of α from 0..1 that rounding in a tracer's sum of weights may leave (a few float ulps).
constexpr float kAoRounding = 1e-6F;

// Writes texel `i` of a grid as "(x, y)".
std::string texel_name(const Grid<float>& grid, size_t i) {
  const size_t width = static_cast<size_t>(grid.width);
  return fmt::format("({}, {})", i % width, i / width);
}

void check_planes(const Bake& bake) {
  const Grid<float>& ao = bake.visible_fraction;
  if (ao.empty()) throw InputError("no channel ao, expected a bake with ao and irradiance among its outputs");
  if (bake.irradiance.empty()) {
    throw InputError("no channel irradiance.00, expected a bake with ao and irradiance among its outputs");
  }
  for (size_t i = 0; i < ao.size(); ++i) {
    if (!(ao[i] >= -kAoRounding && ao[i] <= 1 + kAoRounding)) {
      throw InputError(fmt::format("ao at texel {} is {}, expected 0 to 1", texel_name(ao, i), ao[i]));
    }
  }
  for (size_t b = 0; b < bake.irradiance.size(); ++b) {
    const Grid<float>& irradiance = bake.irradiance[b];
    expect_equal(irradiance.size(), ao.size(), "texels of an irradiance plane");
    for (size_t i = 0; i < irradiance.size(); ++i) {
      if (!(irradiance[i] >= 0 && std::isfinite(irradiance[i]))) {
        throw InputError(fmt::format("irradiance.{:02} at texel {} is {}, expected a finite number from 0", b,
                                     texel_name(ao, i), irradiance[i]));
      }
    }
  }
}

}  // namespace

double bin_center(const CurveBin& bin) { return 0.5 * (bin.ao_low + bin.ao_high); }

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
  if (tail > 0)
    total +=
        series_tail(std::pow(albedo, count - 2) * last / ratio, std::pow(albedo, count - 1) * last, albedo);
  return total / kPi;
}

Curves make_curves(const Bake& bake, int bins) {
  check_planes(bake);
  const Grid<float>& ao = bake.visible_fraction;
  std::vector<size_t> bin_of_texel(ao.size());
  std::vector<Moments> ao_of_bin(static_cast<size_t>(bins));
  for (size_t i = 0; i < ao.size(); ++i) {
    const int index = static_cast<int>(std::floor(bins * static_cast<double>(ao[i])));
    bin_of_texel[i] = static_cast<size_t>(std::clamp(index, 0, bins - 1));
    ao_of_bin[bin_of_texel[i]].add(ao[i]);
  }

  Curves curves;
  curves.bounce_count = static_cast<int>(bake.irradiance.size());
  curves.bins.resize(static_cast<size_t>(bins));
  for (size_t j = 0; j < curves.bins.size(); ++j) {
    CurveBin& bin = curves.bins[j];
    bin.ao_low = static_cast<double>(j) / bins;
    bin.ao_high = static_cast<double>(j + 1) / bins;
    bin.ao_mean = ao_of_bin[j].mean;
    bin.count = static_cast<double>(ao_of_bin[j].count);
    bin.bounces.resize(bake.irradiance.size());
  }
  for (size_t b = 0; b < bake.irradiance.size(); ++b) {
    std::vector<Moments> moments(curves.bins.size());
    for (size_t i = 0; i < ao.size(); ++i) moments[bin_of_texel[i]].add(bake.irradiance[b][i]);
    for (size_t j = 0; j < curves.bins.size(); ++j) {
      curves.bins[j].bounces[b] = {moments[j].mean, moments[j].stddev()};
    }
  }
  return curves;
}

Curves pool_curves(std::span<const Curves> sets) {
  Curves pooled;
  pooled.bounce_count = sets[0].bounce_count;
  for (const Curves& set : sets) {
    pooled.bounce_count = std::min(pooled.bounce_count, set.bounce_count);
    pooled.has_counts = pooled.has_counts && set.has_counts;
    pooled.bins.insert(pooled.bins.end(), set.bins.begin(), set.bins.end());
  }
  for (CurveBin& bin : pooled.bins) bin.bounces.resize(static_cast<size_t>(pooled.bounce_count));
  return pooled;
}

}  // namespace hemibake
