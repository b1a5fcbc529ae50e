#include "bake/map_reading.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/constants.h"

namespace hemibake {
namespace {

// A value stands out that is this many ranges of the others away from them.
constexpr double kOutlierRanges = 10;
// Share of the values beyond each end of the range of the others.
constexpr double kTailShare = 0.005;
// Share of the texels up to which a value of 0..1 is one of few.
constexpr double kLoneShare = 0.001;
constexpr double kFlatRangeOverSize = 1e-5;
constexpr double kSteepestMedianDegrees = 85;

// Values at one end of all, and what is next to them.
struct Extreme {
  double value = 0, next = 0;
  size_t count = 0;
};

// Returns the extreme in the direction of `sign`, of values that are not all the same.
Extreme extreme_of(const std::vector<float>& values, double sign) {
  Extreme found{-HUGE_VAL, -HUGE_VAL, 0};
  for (const float stored : values) {
    const double value = sign * static_cast<double>(stored);
    if (value > found.value) {
      found = {value, found.value, 1};
    } else if (value == found.value) {
      ++found.count;
    } else {
      found.next = std::max(found.next, value);
    }
  }
  return {sign * found.value, sign * found.next, found.count};
}

// Returns the value at a share of all in ascending order.
double quantile(std::vector<float>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return static_cast<double>(*at);
}

// Returns what {nodata} takes for a value.
std::string stored_text(const HeightFile& file, double value) {
  if (file.full_scale == 1) return fmt::format("{}", static_cast<float>(value));
  return fmt::format("{:.0f}", value * file.full_scale);
}

std::string outlier_warning(const HeightFile& file, size_t count, double value, double ranges) {
  const std::string text = stored_text(file, value);
  return fmt::format(
      "{} {} {}, {:.3g} times the range of all others away from them: expected {{nodata}} {} if that stands "
      "for no height",
      count, count == 1 ? "texel is" : "texels are about", text, ranges, text);
}

// Adds a warning where the values at one end stand out. Returns whether they do.
bool warn_of_extreme(const HeightFile& file, const std::vector<float>& values, double sign, bool any_share,
                     std::vector<std::string>& warnings) {
  const Extreme end = extreme_of(values, sign), other = extreme_of(values, -sign);
  const double rest = std::abs(end.next - other.value), gap = std::abs(end.value - end.next);
  const double lone = std::max(1.0, kLoneShare * static_cast<double>(values.size()));
  if (!(rest > 0) || gap <= kOutlierRanges * rest) return false;
  if (!any_share && static_cast<double>(end.count) > lone) return false;
  warnings.push_back(outlier_warning(file, end.count, end.value, gap / rest));
  return true;
}

// Adds a warning where a small share of different values stands out at one end.
void warn_of_tail(const HeightFile& file, const std::vector<float>& values, double low, double high,
                  double sign, std::vector<std::string>& warnings) {
  const double range = high - low,
               limit = sign > 0 ? high + kOutlierRanges * range : -low + kOutlierRanges * range;
  const auto count = static_cast<size_t>(
      std::ranges::count_if(values, [&](float value) { return sign * static_cast<double>(value) > limit; }));
  if (count == 0) return;
  const double value = extreme_of(values, sign).value;
  warnings.push_back(outlier_warning(file, count, value, std::abs(value - (sign > 0 ? high : low)) / range));
}

// Returns the angle to the vertical that half of the normals exceed, degrees.
double median_slope_degrees(const Grid<glm::vec3>& normals) {
  std::vector<float> z;
  z.reserve(normals.size());
  for (const glm::vec3& normal : normals.values) z.push_back(normal.z);
  return std::acos(std::clamp(quantile(z, 0.5), 0.0, 1.0)) * 180 / kPi;
}

}  // namespace

std::vector<std::string> outlier_warnings(const HeightFile& file, bool said_metres) {
  std::vector<std::string> warnings;
  std::vector<float> values;
  values.reserve(file.values.size());
  for (size_t i = 0; i < file.values.size(); ++i)
    if (file.holes.empty() || !file.holes[i]) values.push_back(file.values[i]);
  if (values.empty() || std::ranges::min(values) == std::ranges::max(values)) return warnings;
  const bool any_share = said_metres || file.full_scale == 1 || file.place || std::ranges::min(values) < 0;
  const bool low_stands_out = warn_of_extreme(file, values, -1, any_share, warnings);
  const bool high_stands_out = warn_of_extreme(file, values, 1, any_share, warnings);
  const double low = quantile(values, kTailShare), high = quantile(values, 1 - kTailShare);
  if (high <= low) return warnings;
  if (!low_stands_out) warn_of_tail(file, values, low, high, -1, warnings);
  if (!high_stands_out) warn_of_tail(file, values, low, high, 1, warnings);
  return warnings;
}

std::vector<std::string> surface_warnings(const MapReading& reading, const MapSettings& settings,
                                          const Surface& surface) {
  const HeightUnits& units = reading.units;
  if (units.stored_low == units.stored_high) {
    if (reading.file.channels.size() > 1)
      return {fmt::format("heights are all alike ({:g}), AO will be 1: expected another {{channel}} of {}",
                          units.stored_low, fmt::join(reading.file.channels, ", "))};
    return {fmt::format("heights are all alike ({:g}), AO will be 1", units.stored_low)};
  }
  const double range_m = units.highest_m - units.lowest_m;
  const bool metres = settings.heights == HeightUnit::kMetres;
  if (range_m > 0 && range_m < kFlatRangeOverSize * *settings.size_m)
    return {fmt::format("heights range over {:.3g} m only, on a map of {:g} m: expected another {}{{size}}",
                        range_m, *settings.size_m,
                        metres ? "" : "{amplitude}, {heights} metres where values are metres, or ")};
  if (median_slope_degrees(surface.normals) > kSteepestMedianDegrees)
    return {fmt::format(
        "half of the texels are steeper than {:g} degrees: heights range over {:.4g} m, texels are {:.3g} "
        "m "
        "wide, expected {{size}} or {{texel}} in metres{}",
        kSteepestMedianDegrees, range_m, units.texel_x_m,
        metres ? ", or {heights} unit where values are no metres" : ", or a smaller {amplitude}")};
  return {};
}

}  // namespace hemibake
