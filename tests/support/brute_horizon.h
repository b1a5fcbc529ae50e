// An independent horizon program: from the definition, edge by edge in double precision, without code of the
// tracers or of terrain/.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "surface/surface.h"

namespace hemibake {

// Returns the slope of the horizon of texel (x, y) along (dx, dy): the steepest point of all triangle edges
// that the half-line over the map meets; −∞ where there is none. O(texels).
// sign: −1 turns the surface upside down.
inline double brute_horizon_slope(const Surface& surface, int x, int y, double dx, double dy, double sign = 1,
                                  double radius_m = HUGE_VAL, double drop_per_m2 = 0) {
  const double texel = surface.texel_size_m, here = sign * static_cast<double>(surface.heights_m(x, y));
  double slope = -HUGE_VAL;
  // Meets the edge between two texels where its sides of the line differ.
  const auto meet = [&](int ax, int ay, int bx, int by) {
    const double side_a = dx * (ay - y) - dy * (ax - x), side_b = dx * (by - y) - dy * (bx - x);
    const double tiny = 1e-9;
    const auto rise_to = [&](double px, double py, double height) {
      const double distance = texel * (dx * (px - x) + dy * (py - y));
      if (distance < 1e-9 * texel || distance > radius_m) return;
      slope = std::max(slope, (height - here) / distance - drop_per_m2 * distance);
    };
    const double a = sign * static_cast<double>(surface.heights_m(ax, ay)),
                 b = sign * static_cast<double>(surface.heights_m(bx, by));
    if (std::abs(side_a) < tiny) rise_to(ax, ay, a);
    if (std::abs(side_b) < tiny) rise_to(bx, by, b);
    if (std::min(std::abs(side_a), std::abs(side_b)) < tiny || (side_a < 0) == (side_b < 0)) return;
    const double share = side_a / (side_a - side_b);
    rise_to(ax + share * (bx - ax), ay + share * (by - ay), a + share * (b - a));
  };
  for (int j = 0; j < surface.height(); ++j)
    for (int i = 0; i < surface.width(); ++i) {
      if (i + 1 < surface.width()) meet(i, j, i + 1, j);
      if (j + 1 < surface.height()) meet(i, j, i, j + 1);
      if (i + 1 < surface.width() && j + 1 < surface.height()) meet(i + 1, j, i, j + 1);
    }
  return slope;
}

// Fractions of a hemisphere about a normal that are above the horizon and above the horizontal.
struct BruteSky {
  double uniform, cosine;
};

// Integrates the sky of texel (x, y) with level ground beyond the border, by the midpoint rule over azimuths.
inline BruteSky brute_sky(const Surface& surface, int x, int y, int azimuths) {
  const double pi = std::numbers::pi;
  const auto n = surface.normals(x, y);
  const double nx = n.x, ny = n.y, nz = n.z;
  double uniform = 0, cosine = 0, all_uniform = 0, all_cosine = 0;
  for (int k = 0; k < azimuths; ++k) {
    const double angle = 2 * pi * (k + 0.5) / azimuths, dx = std::cos(angle), dy = std::sin(angle);
    const double run = nx * dx + ny * dy;
    const double tangent = std::atan2(-run, nz);
    const auto above = [&](double low) {  // ∫ (run cos + nz sin) cos from low to the zenith
      const auto antiderivative = [&](double t) {
        return run * (t / 2 + std::sin(2 * t) / 4) + nz * std::sin(t) * std::sin(t) / 2;
      };
      return antiderivative(pi / 2) - antiderivative(low);
    };
    const double slope = brute_horizon_slope(surface, x, y, dx, dy);
    const double horizon = std::max({0.0, tangent, std::atan(slope)});
    uniform += 1 - std::sin(horizon);
    cosine += above(horizon);
    all_uniform += 1 - std::sin(tangent);
    all_cosine += above(tangent);
  }
  return {uniform / all_uniform, cosine / all_cosine};
}

}  // namespace hemibake
