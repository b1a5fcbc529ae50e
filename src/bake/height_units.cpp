#include "bake/height_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/error.h"

namespace hemibake {
namespace {

constexpr double kDefaultSizeM = 1, kDefaultAmplitudeM = 0.1;
// Floats that range over more are no shares of an amplitude.
constexpr double kWidestUnitRange = 2;
// Spacings that differ by less are the same: rounding of a geographic transform.
constexpr double kSquareTolerance = 1e-6;
// Largest integer that a float holds together with all below it.
constexpr double kLargestExact = 1 << 24;

struct Range {
  double low = 0, high = 0;
  double width() const { return high - low; }
};

// Returns the range of the values that are heights.
Range range_of(const HeightFile& file) {
  Range range{HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < file.values.size(); ++i) {
    if (!file.holes.empty() && file.holes[i]) continue;
    range.low = std::min(range.low, static_cast<double>(file.values[i]));
    range.high = std::max(range.high, static_cast<double>(file.values[i]));
  }
  return range.low <= range.high ? range : Range{};
}

bool has_integers(const HeightFile& file) { return file.sample_type.find("integer") != std::string::npos; }

// Returns why the values are metres without a word of the user; kDefault where they are 0..1.
UnitReason reason_for_metres(const HeightFile& file, const Range& range) {
  if (file.in_metres || file.place) return UnitReason::kRaster;
  const bool is_signed = file.sample_type.find("signed") != std::string::npos;
  if (has_integers(file) && (is_signed || range.low < 0 || file.full_scale == 1)) return UnitReason::kSigned;
  if (!has_integers(file) && range.width() > kWidestUnitRange) return UnitReason::kWideFloats;
  return UnitReason::kDefault;
}

// Chooses settings.heights and returns why.
UnitReason choose_unit(const HeightFile& file, const Range& range, MapSettings& settings) {
  // An amplitude of 1 m is what made metres of floats before this could be said.
  const bool scales = settings.amplitude_m.value_or(1) != 1;
  UnitReason reason = settings.heights ? UnitReason::kSaid : reason_for_metres(file, range);
  if (!settings.heights) {
    if (reason == UnitReason::kWideFloats && scales) reason = UnitReason::kAmplitude;
    const bool is_unit =
        reason == UnitReason::kDefault || reason == UnitReason::kAmplitude || settings.high_m.has_value();
    settings.heights = is_unit ? HeightUnit::kUnit : HeightUnit::kMetres;
    if (settings.high_m) reason = UnitReason::kSaid;
  }
  if (settings.heights == HeightUnit::kMetres && scales)
    throw SettingError(fmt::format(
        "{{amplitude}} {:g} scales values of 0..1, but heights are metres{}, expected no {{amplitude}}, or "
        "{{heights}} unit",
        *settings.amplitude_m,
        reason == UnitReason::kSigned   ? " (signed integers)"
        : reason == UnitReason::kRaster ? " (terrain)"
                                        : ""));
  return reason;
}

// Returns the width and height of a texel that the place of a file says, in metres.
std::pair<double, double> texel_of_place(const GeoPlace& place) {
  const auto& t = place.transform;
  return {std::hypot(t[1], t[4]) * place.metres_per_unit, std::hypot(t[2], t[5]) * place.metres_per_unit};
}

void resolve_texel(const HeightFile& file, MapSettings& settings, HeightUnits& units) {
  const int width = file.values.width, height = file.values.height;
  const bool says = settings.size_m || !settings.texel_m.empty();
  units.texel_overrides_file = says && file.place;
  units.texel_from_file = !says && file.place;
  const double aspect = file.pixel_aspect;
  double size_m = settings.size_m.value_or(kDefaultSizeM);
  if (!settings.texel_m.empty()) {
    units.texel_x_m = settings.texel_m[0];
    units.texel_y_m = settings.texel_m.size() > 1 ? settings.texel_m[1] : settings.texel_m[0] / aspect;
  } else if (units.texel_from_file) {
    std::tie(units.texel_x_m, units.texel_y_m) = texel_of_place(*file.place);
  } else {
    units.texel_y_m = size_m / std::max(width * aspect, static_cast<double>(height));
    units.texel_x_m = units.texel_y_m * aspect;
  }
  if (!settings.texel_m.empty() || units.texel_from_file)
    size_m = std::max(width * units.texel_x_m, height * units.texel_y_m);
  settings.size_m = size_m;
  settings.texel_m.clear();
  if (std::abs(units.texel_x_m / units.texel_y_m - 1) > kSquareTolerance)
    settings.texel_m = {units.texel_x_m, units.texel_y_m};
}

// Makes values metres that are integers over their range, exactly where a float can.
void restore_integers(HeightFile& file) {
  if (file.full_scale == 1) return;
  for (float& value : file.values.values) {
    const double stored = static_cast<double>(value) * file.full_scale;
    value = static_cast<float>(file.full_scale <= kLargestExact ? std::round(stored) : stored);
  }
}

void scale_metres(HeightFile& file, MapSettings& settings, HeightUnits& units) {
  restore_integers(file);
  const Range stored = range_of(file);
  settings.amplitude_m = 1;
  units.stored_low = stored.low;
  units.stored_high = stored.high;
  units.lowest_m = stored.low;
  units.highest_m = stored.high;
}

void scale_unit(HeightFile& file, const Range& stored, MapSettings& settings, HeightUnits& units) {
  double black_m = 0, white_m = settings.amplitude_m.value_or(kDefaultAmplitudeM);
  if (settings.high_m) {
    black_m = settings.low_m.value_or(0);
    white_m = *settings.high_m;
  }
  if (white_m < black_m)
    for (float& value : file.values.values) value = static_cast<float>(1 - static_cast<double>(value));
  settings.amplitude_m = std::abs(white_m - black_m);
  units.stored_low = stored.low;
  units.stored_high = stored.high;
  const double of_low_m = black_m + stored.low * (white_m - black_m);
  const double of_high_m = black_m + stored.high * (white_m - black_m);
  units.lowest_m = std::min(of_low_m, of_high_m);
  units.highest_m = std::max(of_low_m, of_high_m);
}

}  // namespace

HeightUnits resolve_units(HeightFile& file, MapSettings& settings) {
  HeightUnits units;
  const Range stored = range_of(file);
  units.reason = choose_unit(file, stored, settings);
  resolve_texel(file, settings, units);
  if (settings.heights == HeightUnit::kMetres)
    scale_metres(file, settings, units);
  else
    scale_unit(file, stored, settings, units);
  return units;
}

}  // namespace hemibake
