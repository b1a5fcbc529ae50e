#include "pictures/color_map.h"

#include <algorithm>
#include <cmath>

#include "core/constants.h"

namespace hemibake {
namespace {

bool on_screen(const glm::dvec3& linear) {
  constexpr double kRounding = 1e-9;
  return std::min({linear.x, linear.y, linear.z}) >= -kRounding &&
         std::max({linear.x, linear.y, linear.z}) <= 1 + kRounding;
}

// Returns the colour of a lightness and hue with the chroma asked for, or as much as the screen has.
glm::dvec3 screen_color(double lightness, double chroma, double hue_rad) {
  const auto color = [&](double c) {
    return linear_from_oklab({lightness, c * std::cos(hue_rad), c * std::sin(hue_rad)});
  };
  double reached = chroma;
  if (!on_screen(color(chroma))) {
    double inside = 0, outside = chroma;
    for (int i = 0; i < 40; ++i) {
      const double middle = (inside + outside) / 2;
      (on_screen(color(middle)) ? inside : outside) = middle;
    }
    reached = inside;
  }
  const glm::dvec3 linear = color(reached);
  return {std::clamp(linear.x, 0.0, 1.0), std::clamp(linear.y, 0.0, 1.0), std::clamp(linear.z, 0.0, 1.0)};
}

double radians(double degrees) { return degrees * kPi / 180; }

}  // namespace

glm::dvec3 linear_from_oklab(const glm::dvec3& lab) {
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lab.x + 0.3963377774 * lab.y + 0.2158037573 * lab.z);
  const double m = cube(lab.x - 0.1055613458 * lab.y - 0.0638541728 * lab.z);
  const double s = cube(lab.x - 0.0894841775 * lab.y - 1.2914855480 * lab.z);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

glm::dvec3 oklab_from_linear(const glm::dvec3& rgb) {
  const double l = std::cbrt(0.4122214708 * rgb.x + 0.5363325363 * rgb.y + 0.0514459929 * rgb.z);
  const double m = std::cbrt(0.2119034982 * rgb.x + 0.6806995451 * rgb.y + 0.1073969566 * rgb.z);
  const double s = std::cbrt(0.0883024619 * rgb.x + 0.2817188376 * rgb.y + 0.6299787005 * rgb.z);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

glm::dvec3 sequential_color(double value) {
  const double v = std::clamp(value, 0.0, 1.0);
  // From blue-violet over green to yellow, against the circle of hues; chroma that the screen has all along.
  return screen_color(0.2 + 0.75 * v, 0.13, radians(290 - 185 * v));
}

glm::dvec3 diverging_color(double value) {
  const double v = std::clamp(value, -1.0, 1.0), size = std::abs(v);
  return screen_color(0.97 - 0.52 * size, 0.2 * size, radians(v < 0 ? 255 : 30));
}

double round_scale(double value) {
  if (!(value > 0)) return 1;
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0})
    if (step * decade >= value * (1 - 1e-12)) return step * decade;
  return 10 * decade;
}

}  // namespace hemibake
