#include "estimators/alchemy.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "core/constants.h"
#include "core/parallel.h"

namespace hemibake {
namespace {

double obscurance_at(const GeometryBuffer& buffer, int x, int y, const AlchemyOptions& options,
                     double radius_m) {
  const auto here = buffer.read(x, y);
  if (!here) return 0;
  const double c = options.falloff_start * radius_m;
  const double radius_pixels = radius_m * buffer.scale_at(here->depth_m);
  const double rotation = spiral_rotation(x, y);
  double sum = 0;
  for (int i = 0; i < options.taps; ++i) {
    const glm::dvec2 tap = radius_pixels * spiral_tap(i, options.taps, rotation);
    const auto there =
        buffer.read(x + static_cast<int>(std::lround(tap.x)), y + static_cast<int>(std::lround(tap.y)));
    if (!there) continue;
    const glm::dvec3 to_tap = there->position_m - here->position_m;
    const double distance2 = glm::dot(to_tap, to_tap);
    if (distance2 > radius_m * radius_m) continue;
    const double above = glm::dot(here->normal, to_tap) - options.bias * there->depth_m;
    sum += std::max(0.0, above) / std::max(c * c, distance2);
  }
  return 2 * kPi * c / options.taps * sum;
}

// Copies to every texel the AO of the pixel that shows it.
void copy_to_texels(const Surface& surface, const CameraView& view, const GeometryBuffer& buffer,
                    const Grid<float>& image, Estimate& estimate) {
  const double t = surface.texel_size_m;
  for (int y = 0; y < surface.height(); ++y) {
    for (int x = 0; x < surface.width(); ++x) {
      const glm::dvec3 at = view.project({(x + 0.5) * t, (y + 0.5) * t, surface.heights_m(x, y)});
      const int column = static_cast<int>(std::floor(at.x)), row = static_cast<int>(std::floor(at.y));
      const auto shown = column >= 0 && row >= 0 ? buffer.read(column, row) : std::nullopt;
      // Two pixels or texels of slack: the centre of the pixel shows another point of the same slope.
      const double slack_m = 2 * std::max(t, 1 / buffer.scale_at(at.z));
      const bool shows_texel = shown && at.z <= shown->depth_m + slack_m;
      estimate.ao(x, y) = shows_texel ? image(column, row) : 1.0f;
      estimate.known(x, y) = shows_texel;
    }
  }
}

}  // namespace

glm::dvec2 spiral_tap(int i, int taps, double rotation) {
  const double along = (i + 0.5) / taps;
  const double angle = 2 * kPi * along * (7.0 * taps / 9) + rotation;
  return along * glm::dvec2(std::cos(angle), std::sin(angle));
}

double spiral_rotation(int x, int y) {
  const int64_t wide_x = x, wide_y = y;
  return static_cast<double>(((30 * wide_x) ^ wide_y) + 10 * wide_x * wide_y);
}

Grid<double> alchemy_obscurance(const GeometryBuffer& buffer, const AlchemyOptions& options,
                                double radius_m) {
  Grid<double> obscurance(buffer.pixels.width, buffer.pixels.height);
  parallel_for(static_cast<size_t>(obscurance.height), 1, [&](size_t begin, size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < obscurance.width; ++x)
        obscurance(x, y) = obscurance_at(buffer, x, y, options, radius_m);
  });
  return obscurance;
}

AlchemyImages alchemy_images(const GeometryBuffer& buffer, const AlchemyOptions& options, double radius_m) {
  const Grid<double> obscurance = alchemy_obscurance(buffer, options, radius_m);
  AlchemyImages images;
  images.raw = Grid<float>(obscurance.width, obscurance.height);
  for (size_t i = 0; i < obscurance.size(); ++i)
    images.raw[i] = static_cast<float>(
        std::pow(std::clamp(1 - options.scale * obscurance[i], 0.0, 1.0), options.contrast));
  images.blurred_rows = images.blurred = images.raw;
  if (options.blur == BlurPasses::kNone) return images;
  const BlurOptions& blur = options.blur_options;
  const double variance = blur.depth_variance_m2 > 0 ? blur.depth_variance_m2 : 0.01 * radius_m * radius_m;
  images.blurred_rows =
      bilateral_blur_pass(images.raw, buffer, blur.radius_pixels, variance, BlurAxis::kRows);
  images.blurred = images.blurred_rows;
  if (options.blur == BlurPasses::kRows) return images;
  images.blurred =
      bilateral_blur_pass(images.blurred_rows, buffer, blur.radius_pixels, variance, BlurAxis::kColumns);
  return images;
}

double alchemy_radius_m(const Surface& surface, const AlchemyOptions& options) {
  if (options.radius_m > 0) return options.radius_m;
  const double longer_side_m = surface.texel_size_m * std::max(surface.width(), surface.height());
  return std::max(std::min(height_range_m(surface), 0.5 * longer_side_m), 2 * surface.texel_size_m);
}

Estimate estimate_alchemy(const Surface& surface, const AlchemyOptions& options) {
  const double radius_m = alchemy_radius_m(surface, options);
  Estimate estimate;
  estimate.kind = AoKind::kCosine;
  if (options.projection == Projection::kOrthographic) {
    const GeometryBuffer buffer = orthographic_buffer(surface, options.camera_height_m);
    estimate.ao = alchemy_images(buffer, options, radius_m).blurred;
    estimate.work = buffer.pixels.size() * static_cast<uint64_t>(options.taps);
    return estimate;
  }
  const GeometryBuffer buffer = perspective_buffer(surface, options.camera);
  estimate.ao = Grid<float>(surface.width(), surface.height());
  estimate.known = Grid<uint8_t>(surface.width(), surface.height());
  const AlchemyImages images = alchemy_images(buffer, options, radius_m);
  copy_to_texels(surface, camera_view(surface, options.camera), buffer, images.blurred, estimate);
  estimate.work = buffer.pixels.size() * static_cast<uint64_t>(options.taps);
  return estimate;
}

}  // namespace hemibake
