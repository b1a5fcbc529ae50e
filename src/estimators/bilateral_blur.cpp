#include "estimators/bilateral_blur.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "core/parallel.h"

namespace hemibake {

Grid<float> bilateral_blur_pass(const Grid<float>& values, const GeometryBuffer& buffer, int radius_pixels,
                                double depth_variance_m2, BlurAxis axis) {
  std::vector<double> spatial(static_cast<size_t>(radius_pixels) + 1, 1.0);
  const double deviation = 0.5 * radius_pixels;
  for (size_t i = 1; i < spatial.size(); ++i) {
    const double distance = static_cast<double>(i) / deviation;
    spatial[i] = std::exp(-0.5 * distance * distance);
  }

  Grid<float> blurred(values.width, values.height);
  parallel_for(static_cast<size_t>(values.height), 1, [&](size_t begin, size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < values.width; ++x) {
        blurred(x, y) = values(x, y);
        const auto here = buffer.read(x, y);
        if (!here) continue;
        double sum = 0, weights = 0;
        for (int step = -radius_pixels; step <= radius_pixels; ++step) {
          const int at_x = axis == BlurAxis::kRows ? x + step : x,
                    at_y = axis == BlurAxis::kRows ? y : y + step;
          const auto there = buffer.read(at_x, at_y);
          if (!there) continue;
          const double depth = there->depth_m - here->depth_m;
          // The factor 1/√(2πs) of the range kernel cancels against the sum of the weights.
          const double weight = spatial[static_cast<size_t>(std::abs(step))] *
                                std::max(0.0, glm::dot(here->normal, there->normal)) *
                                std::exp(-depth * depth / (2 * depth_variance_m2));
          sum += weight *
                 static_cast<double>(values(wrap_index(at_x, values.width), wrap_index(at_y, values.height)));
          weights += weight;
        }
        // A mean of values of 0..1, kept there against rounding; the pixel's own weight is 1.
        blurred(x, y) = static_cast<float>(std::clamp(sum / weights, 0.0, 1.0));
      }
    }
  });
  return blurred;
}

}  // namespace hemibake
