#include "report/html_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/constants.h"
#include "core/error.h"
#include "core/parallel.h"
#include "io/compress.h"

namespace hemibake {
namespace {

constexpr double kLargestCode = 65535;
constexpr const char* kIrradiance = "irradiance.";

using Codes = Grid<uint16_t>;

Grid<float> thin_out(const Grid<float>& plane, int stride, const std::string& name) {
  Grid<float> kept((plane.width + stride - 1) / stride, (plane.height + stride - 1) / stride);
  for (int y = 0; y < kept.height; ++y)
    for (int x = 0; x < kept.width; ++x) {
      const float value = plane(x * stride, y * stride);
      if (!(value >= 0) || !std::isfinite(value))
        throw InputError(fmt::format("{} of texel {},{} is {}, expected a finite number of at least 0", name,
                                     x * stride, y * stride, value));
      kept(x, y) = value;
    }
  return kept;
}

double largest(const Grid<float>& plane) {
  return *std::max_element(plane.values.begin(), plane.values.end());
}

Codes quantize(const Grid<float>& plane, double step) {
  Codes codes(plane.width, plane.height);
  for (size_t i = 0; i < codes.size(); ++i) codes[i] = static_cast<uint16_t>(std::lround(plane[i] / step));
  return codes;
}

uint16_t predict(const Codes& codes, int x, int y) {
  const int left = x > 0 ? codes(x - 1, y) : 0;
  const int above = y > 0 ? codes(x, y - 1) : 0;
  const int corner = x > 0 && y > 0 ? codes(x - 1, y - 1) : 0;
  const auto [low, high] = std::minmax(left, above);
  return static_cast<uint16_t>(std::clamp(left + above - corner, low, high));
}

std::string pack(const Codes& codes) {
  std::vector<uint8_t> bytes(2 * codes.size());
  for (int y = 0; y < codes.height; ++y)
    for (int x = 0; x < codes.width; ++x) {
      const auto difference = static_cast<uint16_t>(codes(x, y) - predict(codes, x, y));
      // Small differences of either sign as small numbers: 0, −1, 1, −2, …
      const auto folded = static_cast<uint16_t>(difference << 1 ^ (difference & 0x8000 ? 0xffff : 0));
      bytes[codes.index(x, y)] = static_cast<uint8_t>(folded);
      bytes[codes.size() + codes.index(x, y)] = static_cast<uint8_t>(folded >> 8);
    }
  return base64(deflate_bytes(bytes));
}

bool is_irradiance(const PackedPlane& plane) { return plane.name.starts_with(kIrradiance); }

// Sets the errors of `packed`. plane_error: the largest of each plane.
void set_errors(const std::vector<Grid<float>>& kept, const std::vector<Codes>& codes,
                const std::vector<double>& plane_error, PackedPlanes& packed) {
  for (size_t p = 0; p < kept.size(); ++p) {
    const PackedPlane& plane = packed.planes[p];
    double& error = is_irradiance(plane)     ? packed.irradiance_error_over_pi
                    : plane.name == "bounce" ? packed.bounce_error
                                             : packed.ao_error;
    error = std::max(error, is_irradiance(plane) ? plane_error[p] / kPi : plane_error[p]);
  }
  for (size_t i = 0; i < kept[0].size(); ++i) {
    double sum = 0;
    for (size_t p = 0; p < kept.size(); ++p)
      if (is_irradiance(packed.planes[p])) sum += codes[p][i] * packed.planes[p].step - kept[p][i];
    packed.total_error_over_pi = std::max(packed.total_error_over_pi, std::abs(sum) / kPi);
  }
}

}  // namespace

PackedPlanes pack_planes(const Bake& bake, int largest_side) {
  PackedPlanes packed;
  packed.stride = (std::max(bake.width, bake.height) + largest_side - 1) / largest_side;
  std::vector<Grid<float>> kept;
  const auto keep = [&](const Grid<float>& plane, const std::string& name) {
    if (plane.empty()) return;
    kept.push_back(thin_out(plane, packed.stride, name));
    packed.planes.push_back({name, 0, ""});
  };
  keep(bake.visible_fraction, "ao");
  for (size_t b = 0; b < bake.irradiance.size(); ++b)
    keep(bake.irradiance[b], fmt::format("{}{:02}", kIrradiance, b));
  keep(bake.bounce, "bounce");
  if (bake.irradiance.empty()) keep(bake.visibility, "visibility");
  if (kept.empty()) return packed;
  packed.width = kept[0].width;
  packed.height = kept[0].height;

  // One step for all bounces: the late ones, which are small, then need few bits. E of a cone or of a march
  // may exceed π a little.
  double irradiance_largest = kPi;
  for (size_t p = 0; p < kept.size(); ++p)
    if (is_irradiance(packed.planes[p])) irradiance_largest = std::max(irradiance_largest, largest(kept[p]));
  for (size_t p = 0; p < kept.size(); ++p)
    packed.planes[p].step =
        (is_irradiance(packed.planes[p]) ? irradiance_largest : std::max(1.0, largest(kept[p]))) /
        kLargestCode;

  std::vector<double> plane_error(kept.size());
  std::vector<Codes> codes(kept.size());
  parallel_for(kept.size(), 1, [&](size_t begin, size_t end) {
    for (size_t p = begin; p < end; ++p) {
      const double step = packed.planes[p].step;
      codes[p] = quantize(kept[p], step);
      for (size_t i = 0; i < kept[p].size(); ++i)
        plane_error[p] = std::max(plane_error[p], std::abs(codes[p][i] * step - kept[p][i]));
      packed.planes[p].base64 = pack(codes[p]);
    }
  });
  set_errors(kept, codes, plane_error, packed);
  return packed;
}

}  // namespace hemibake
