#include "terrain/horizon_path.h"

#include <algorithm>
#include <cmath>

namespace hemibake {
namespace {

// Crossing with the edge from (x, y) along (edge_x, edge_y), in texels from the start.
struct EdgeCrossing {
  int x, y, edge_x, edge_y;
  double fraction, distance;
};

// Appends the crossings of a path with the lines x = k, y = k and x + y = k.
void append_crossings(double dx, double dy, double longest, std::vector<EdgeCrossing>& crossings) {
  const double speeds[3] = {dx, dy, dx + dy};
  for (int family = 0; family < 3; ++family) {
    const double speed = speeds[family];
    if (std::abs(speed) < 1e-12) continue;
    for (int k = 1; k <= longest * std::abs(speed) + kOnTexel; ++k) {
      const int line = speed > 0 ? k : -k;
      const double distance = line / speed, x = distance * dx, y = distance * dy;
      // Edges of x = line run along y, the others along x; diagonals from (i, line − i) to (i + 1, …− 1).
      const double along = family == 0 ? y : x;
      const double floor = std::floor(along + kOnTexel);
      const int i = static_cast<int>(floor);
      double fraction = std::max(0.0, along - floor);
      if (fraction < kOnTexel) fraction = 0;
      const int edge_x = family == 0 ? 0 : 1, edge_y = family == 0 ? 1 : family == 1 ? 0 : -1;
      if (family == 0) crossings.push_back({line, i, edge_x, edge_y, fraction, distance});
      if (family == 1) crossings.push_back({i, line, edge_x, edge_y, fraction, distance});
      if (family == 2) crossings.push_back({i, line - i, edge_x, edge_y, fraction, distance});
    }
  }
  std::ranges::stable_sort(crossings, {}, &EdgeCrossing::distance);
}

double piece_length(double dx, double dy) { return kPieceTexels / std::max(std::abs(dx), std::abs(dy)); }

HorizonWindow window_from(int corner_x, int corner_y, double near, double far, double drop) {
  return {corner_x,
          corner_y,
          static_cast<float>(near),
          static_cast<float>(1 / near),
          static_cast<float>(1 / far),
          static_cast<float>(drop * near)};
}

}  // namespace

int window_texels(double direction, double other, size_t level) {
  const double length = std::abs(direction) * piece_length(direction, other) * kWindowPieces[level];
  // One texel wider on either side than the stretch of the path.
  return static_cast<int>(std::ceil(length - kOnTexel)) + 3;
}

HorizonPath find_horizon_path(double azimuth, double longest, double drop, int pitch) {
  // Paths along the grid stay on it.
  const auto exact = [](double v) { return std::abs(v) < 1e-12 ? 0 : v; };
  HorizonPath path{exact(std::sin(azimuth)), exact(-std::cos(azimuth)), {}, {}, {}};
  std::vector<EdgeCrossing> crossings;
  append_crossings(path.x, path.y, longest, crossings);
  path.crossings.reserve(crossings.size());
  const double step = piece_length(path.x, path.y);
  for (size_t i = 0; i < crossings.size();) {
    const auto number_of = [&](const EdgeCrossing& c) { return std::floor(c.distance / step); };
    const double number = number_of(crossings[i]), near = crossings[i].distance;
    // A crossing at the end of a piece by rounding has its vertices one texel out at most.
    const auto corner = [&](double direction, double far) {
      return static_cast<int>(std::floor((direction < 0 ? far : step * number) * direction - kOnTexel)) - 1;
    };
    for (size_t level = 0; level < kWindowLevels; ++level)
      if (path.pieces.size() % static_cast<size_t>(kWindowPieces[level]) == 0) {
        const double far = step * (number + kWindowPieces[level]);
        path.windows[level].push_back(window_from(corner(path.x, far), corner(path.y, far), near, far, drop));
      }
    const int corner_x = corner(path.x, step * (number + 1)), corner_y = corner(path.y, step * (number + 1));
    HorizonPiece piece{static_cast<uint32_t>(path.crossings.size()), 0};
    for (; i < crossings.size() && number_of(crossings[i]) == number; ++i) {
      const EdgeCrossing& c = crossings[i];
      const int a = (c.y - corner_y) * pitch + c.x - corner_x;
      const int b = c.fraction > 0 ? a + c.edge_y * pitch + c.edge_x : a;
      path.crossings.push_back({a, b, static_cast<float>(c.fraction), static_cast<float>(1 / c.distance),
                                static_cast<float>(drop * c.distance)});
    }
    piece.end = static_cast<uint32_t>(path.crossings.size());
    path.pieces.push_back(piece);
  }
  return path;
}

}  // namespace hemibake
