#include "terrain/horizon_tracer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace hemibake {
namespace {

constexpr int kPieceTexels = 8;   // length of a piece along x or y, whichever is longer
constexpr int kGroupPieces = 14;  // pieces skipped at once
// A window is one texel wider on either side than its piece or group, and at most as wide as a block.
constexpr int kPieceBlock = 16, kGroupBlock = 128;
static_assert(kPieceTexels + 3 <= kPieceBlock && kGroupPieces * kPieceTexels + 3 <= kGroupBlock);

// Texels: a path this close to a texel centre goes through it.
constexpr double kOnTexel = 1e-9;
constexpr double kFarthestTexels = 65536, kFarthestRanges = 1e4;

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

}  // namespace

HorizonTracer::HorizonTracer(const Surface& surface, const HorizonReach& reach, bool inverted)
    : width_(surface.width()), height_(surface.height()), edge_(surface.edge) {
  const int repeated = edge_ == Edge::kWrap ? kPieceBlock : 0;
  heights_ = Grid<float>(width_ + repeated, height_ + repeated);
  const double scale = (inverted ? -1 : 1) / surface.texel_size_m;
  for (int y = 0; y < heights_.height; ++y)
    for (int x = 0; x < heights_.width; ++x)
      heights_(x, y) = static_cast<float>(
          scale * static_cast<double>(surface.heights_m(wrap_index(x, width_), wrap_index(y, height_))));
  top_ = *std::ranges::max_element(heights_.values);
  radius_ = reach.radius_m / surface.texel_size_m;
  drop_ = reach.drop_per_m2 * surface.texel_size_m;
  longest_ = std::hypot(width_, height_);
  if (edge_ == Edge::kWrap)
    longest_ = std::min(kFarthestTexels, kFarthestRanges * height_range_m(surface) / surface.texel_size_m);
  longest_ = std::min(longest_, radius_);
  const bool ends_at_horizontal = edge_ != Edge::kOpen && std::isinf(radius_) && drop_ == 0;
  lowest_slope_ = ends_at_horizontal ? 0 : -HUGE_VAL;
  max_mips_ = {make_max_mip(kPieceBlock), make_max_mip(kGroupBlock)};
}

HorizonTracer::MaxMip HorizonTracer::make_max_mip(int block) const {
  MaxMip mip{block, Grid<float>((width_ + block - 1) / block, (height_ + block - 1) / block)};
  parallel_for(static_cast<size_t>(mip.values.height), 1, [&](size_t begin, size_t end) {
    for (int v = static_cast<int>(begin); v < static_cast<int>(end); ++v)
      for (int u = 0; u < mip.values.width; ++u) {
        float most = -std::numeric_limits<float>::infinity();
        for (int y = v * block; y < (v + 2) * block; ++y)
          for (int x = u * block; x < (u + 2) * block; ++x)
            most =
                std::max(most, heights_(wrap_or_clamp(x, width_, edge_), wrap_or_clamp(y, height_, edge_)));
        mip.values(u, v) = most;
      }
  });
  return mip;
}

HorizonTracer::Path HorizonTracer::make_path(double azimuth) const {
  // Paths along the grid stay on it.
  const auto exact = [](double v) { return std::abs(v) < 1e-12 ? 0 : v; };
  Path path{exact(std::sin(azimuth)), exact(-std::cos(azimuth)), {}, {}, {}};
  std::vector<EdgeCrossing> crossings;
  append_crossings(path.x, path.y, longest_, crossings);
  const double step = kPieceTexels / std::max(std::abs(path.x), std::abs(path.y));
  for (size_t i = 0; i < crossings.size();) {
    const auto number_of = [&](const EdgeCrossing& c) { return std::floor(c.distance / step); };
    const double number = number_of(crossings[i]), near = step * number, far = near + step;
    // A crossing at the end of a piece by rounding has its vertices one texel out at most.
    const auto corner = [&](double direction) {
      return static_cast<int>(std::floor((direction < 0 ? far : near) * direction - kOnTexel)) - 1;
    };
    const Window window{corner(path.x), corner(path.y), crossings[i].distance, far};
    Piece piece{window, static_cast<uint32_t>(path.crossings.size()), 0};
    for (; i < crossings.size() && number_of(crossings[i]) == number; ++i) {
      const EdgeCrossing& c = crossings[i];
      const int pitch = heights_.width, a = (c.y - window.corner_y) * pitch + c.x - window.corner_x;
      const int b = c.fraction > 0 ? a + c.edge_y * pitch + c.edge_x : a;
      path.crossings.push_back({a, b, c.fraction, c.distance});
    }
    piece.end = static_cast<uint32_t>(path.crossings.size());
    if (path.pieces.size() % kGroupPieces == 0) path.groups.push_back(window);
    Window& group = path.groups.back();
    group.corner_x = std::min(group.corner_x, window.corner_x);
    group.corner_y = std::min(group.corner_y, window.corner_y);
    group.far = far;
    path.pieces.push_back(piece);
  }
  return path;
}

// Returns whether the heights of a window are below a slope from the start (x, y).
bool HorizonTracer::is_below(const MaxMip& mip, const Window& window, int x, int y, double slope) const {
  const auto block = [&](int i, int n) {
    return edge_ == Edge::kWrap ? wrap_index(i, n) / mip.block : std::clamp(i, 0, n - 1) / mip.block;
  };
  const double tall = mip.values(block(x + window.corner_x, width_), block(y + window.corner_y, height_));
  const double rise = tall - static_cast<double>(heights_(x, y));
  return rise / (rise > 0 ? window.near : window.far) - drop_ * window.near <= slope;
}

// Returns the distance at which a path from (x, y) leaves the map, texels; ∞ where the map wraps.
double HorizonTracer::distance_to_border(const Path& path, int x, int y) const {
  if (edge_ == Edge::kWrap) return HUGE_VAL;
  const auto along = [](double direction, int i, int n) {
    if (direction == 0) return HUGE_VAL;
    return direction > 0 ? (n - 1 - i) / direction : i / -direction;
  };
  return std::min(along(path.x, x, width_), along(path.y, y, height_));
}

// Returns the steepest slope to the ground that goes on level from the border.
double HorizonTracer::ground_slope(const Path& path, int x, int y, double border) const {
  const double at_x = std::clamp(x + border * path.x, 0.0, width_ - 1.0),
               at_y = std::clamp(y + border * path.y, 0.0, height_ - 1.0);
  const int i = std::min(static_cast<int>(at_x), width_ - 2),
            j = std::min(static_cast<int>(at_y), height_ - 2);
  const double u = at_x - i, v = at_y - j;
  const auto height = [&](int dx, int dy) { return static_cast<double>(heights_(i + dx, j + dy)); };
  const double rise = (1 - v) * ((1 - u) * height(0, 0) + u * height(1, 0)) +
                      v * ((1 - u) * height(0, 1) + u * height(1, 1)) - static_cast<double>(heights_(x, y));
  // rise / r − drop · r has its maximum where r² = −rise / drop.
  const double farthest = drop_ > 0 && rise < 0 ? std::sqrt(-rise / drop_) : rise < 0 ? HUGE_VAL : border;
  const double distance = std::clamp(farthest, border, std::max(border, radius_));
  return distance > 0 ? rise / distance - drop_ * distance : 0;
}

double HorizonTracer::horizon(const Path& path, int x, int y) const {
  const double here = heights_(x, y), border = distance_to_border(path, x, y), limit = border + kOnTexel / 2;
  double slope = lowest_slope_;
  for (size_t p = 0; p < path.pieces.size();) {
    const Piece& piece = path.pieces[p];
    const double near = piece.window.near;
    if (near > limit || (top_ - here) / near - drop_ * near <= slope) break;
    const bool group_begins = p % kGroupPieces == 0;
    if (group_begins && is_below(max_mips_[1], path.groups[p / kGroupPieces], x, y, slope)) {
      p += kGroupPieces;
      continue;
    }
    ++p;
    if (is_below(max_mips_[0], piece.window, x, y, slope)) continue;
    int corner_x = x + piece.window.corner_x, corner_y = y + piece.window.corner_y;
    if (edge_ == Edge::kWrap) {
      corner_x = wrap_index(corner_x, width_);
      corner_y = wrap_index(corner_y, height_);
    }
    const std::ptrdiff_t corner = std::ptrdiff_t{corner_y} * heights_.width + corner_x;
    for (uint32_t c = piece.first; c < piece.end; ++c) {
      const Crossing& crossing = path.crossings[c];
      if (crossing.distance > limit) break;
      const double a = heights_.values[static_cast<size_t>(corner + crossing.a)],
                   b = heights_.values[static_cast<size_t>(corner + crossing.b)];
      const double rise = a + crossing.fraction * (b - a) - here;
      slope = std::max(slope, rise / crossing.distance - drop_ * crossing.distance);
    }
  }
  const bool over_ground = edge_ == Edge::kGround && border < radius_ && lowest_slope_ < 0;
  return over_ground ? std::max(slope, ground_slope(path, x, y, border)) : slope;
}

Grid<float> HorizonTracer::trace(double azimuth) const {
  const Path path = make_path(azimuth);
  Grid<float> slopes(width_, height_);
  parallel_for(static_cast<size_t>(height_), 1, [&](size_t begin, size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width_; ++x) slopes(x, y) = static_cast<float>(horizon(path, x, y));
  });
  return slopes;
}

}  // namespace hemibake
