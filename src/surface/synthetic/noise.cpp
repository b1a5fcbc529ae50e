#include "surface/synthetic/noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/grid.h"
#include "sampling/low_discrepancy.h"

namespace hemibake {
namespace {

// A point in its lattice cell: x, y in [0, 1).
struct LatticePoint {
  int cell_x, cell_y;
  double x, y;
};

LatticePoint lattice_point(double x, double y, Tile tile, int cells_x, int cells_y) {
  const double u = x / tile.width * cells_x, v = y / tile.height * cells_y;
  return {static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)), u - std::floor(u),
          v - std::floor(v)};
}

// Returns the hashed gradient of a lattice node times the vector from the node to the point.
double gradient_ramp(uint64_t seed, int node_x, int node_y, double dx, double dy) {
  const uint64_t bits = hash_bits(seed, node_x, node_y);
  constexpr double kHalf32 = 1.0 / (uint64_t{1} << 31);
  const double gradient_x = static_cast<double>(bits >> 32) * kHalf32 - 1;
  const double gradient_y = static_cast<double>(bits & 0xffffffffu) * kHalf32 - 1;
  return gradient_x * dx + gradient_y * dy;
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

}  // namespace

int cells_along(double side, double frequency) {
  return std::max(1, static_cast<int>(std::lround(side * frequency)));
}

uint64_t hash_bits(uint64_t seed, int64_t x, int64_t y) {
  // Spreads small x over all bits of the stream.
  return mix_bits(seed, 0x9e3779b97f4a7c15u * static_cast<uint64_t>(x), static_cast<uint64_t>(y));
}

double hash_unit(uint64_t seed, int64_t x, int64_t y) { return unit_interval(hash_bits(seed, x, y)); }

double smooth_step(double low, double high, double value) {
  const double t = std::clamp((value - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double tile_noise(double x, double y, Tile tile, double frequency, uint64_t seed) {
  const int cells_x = cells_along(tile.width, frequency), cells_y = cells_along(tile.height, frequency);
  const LatticePoint p = lattice_point(x, y, tile, cells_x, cells_y);
  const int x0 = wrap_index(p.cell_x, cells_x), x1 = wrap_index(p.cell_x + 1, cells_x);
  const int y0 = wrap_index(p.cell_y, cells_y), y1 = wrap_index(p.cell_y + 1, cells_y);
  const double across = fade(p.x), down = fade(p.y);
  const double top =
      std::lerp(gradient_ramp(seed, x0, y0, p.x, p.y), gradient_ramp(seed, x1, y0, p.x - 1, p.y), across);
  const double bottom = std::lerp(gradient_ramp(seed, x0, y1, p.x, p.y - 1),
                                  gradient_ramp(seed, x1, y1, p.x - 1, p.y - 1), across);
  return std::lerp(top, bottom, down);
}

double fractal_noise(double x, double y, Tile tile, const FractalNoise& noise) {
  double sum = 0, amplitude = 1, frequency = noise.frequency;
  uint64_t octave = 0;
  do {
    sum += amplitude *
           tile_noise(x, y, tile, frequency, hash_bits(noise.seed, 0, static_cast<int64_t>(octave++)));
    amplitude *= noise.gain;
    frequency *= 2;
  } while (frequency <= noise.highest_frequency);
  return sum;
}

Spot nearest_spot(double x, double y, Tile tile, double frequency, uint64_t seed) {
  const int cells_x = cells_along(tile.width, frequency), cells_y = cells_along(tile.height, frequency);
  const LatticePoint p = lattice_point(x, y, tile, cells_x, cells_y);
  Spot nearest{std::numeric_limits<double>::infinity(), 0};
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const uint64_t bits =
          hash_bits(seed, wrap_index(p.cell_x + i, cells_x), wrap_index(p.cell_y + j, cells_y));
      const double dx = (i + hash_unit(bits, 0, 0) - p.x) * tile.width / cells_x;
      const double dy = (j + hash_unit(bits, 0, 1) - p.y) * tile.height / cells_y;
      const double distance = std::sqrt(dx * dx + dy * dy);
      if (distance < nearest.distance) nearest = {distance, bits};
    }
  }
  return nearest;
}

VoronoiCell voronoi_cell(double x, double y, Tile tile, double frequency, double jitter, uint64_t seed) {
  const int cells_x = cells_along(tile.width, frequency), cells_y = cells_along(tile.height, frequency);
  const LatticePoint p = lattice_point(x, y, tile, cells_x, cells_y);
  VoronoiCell found{0, 0, std::numeric_limits<double>::infinity(), 0};
  const auto from_site = [&](int i, int j) {
    const uint64_t bits =
        hash_bits(seed, wrap_index(p.cell_x + i, cells_x), wrap_index(p.cell_y + j, cells_y));
    const double site_x = 0.5 + jitter * (hash_unit(bits, 0, 0) - 0.5);
    const double site_y = 0.5 + jitter * (hash_unit(bits, 0, 1) - 0.5);
    return VoronoiCell{(p.x - i - site_x) * tile.width / cells_x, (p.y - j - site_y) * tile.height / cells_y,
                       0, bits};
  };
  int nearest_i = 0, nearest_j = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      const VoronoiCell site = from_site(i, j);
      const double distance = std::hypot(site.x, site.y);
      if (distance >= nearest) continue;
      nearest = distance;
      nearest_i = i, nearest_j = j;
      found.x = site.x, found.y = site.y, found.bits = site.bits;
    }
  }
  for (int j = nearest_j - 2; j <= nearest_j + 2; ++j) {
    for (int i = nearest_i - 2; i <= nearest_i + 2; ++i) {
      if (i == nearest_i && j == nearest_j) continue;
      const VoronoiCell other = from_site(i, j);
      const double apart = std::hypot(found.x - other.x, found.y - other.y);
      const double farther = std::hypot(other.x, other.y);
      found.border = std::min(found.border, (farther * farther - nearest * nearest) / (2 * apart));
    }
  }
  return found;
}

}  // namespace hemibake
