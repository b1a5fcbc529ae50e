#include "terrain/horizon_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "terrain/horizon_walk.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace hemibake {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Products and sums are rounded one by one: the same bytes with every instruction set.
using F = hn::CappedTag<float, kHorizonLanes>;
using V = hn::Vec<F>;
constexpr F kF;
constexpr size_t kWidth = hn::MaxLanes(F());
constexpr size_t kParts = kHorizonLanes / kWidth;

HWY_INLINE V broadcast(float value) { return hn::Set(kF, value); }

// Texels of a packet, and their horizons so far.
struct Packet {
  int x, y;
  V here[kParts];    // heights
  V slope[kParts];   // ∞ of lanes beyond the row
  V border[kParts];  // at least the distance at which the path leaves the map
  float farthest;    // of the lanes' borders
};

// Returns at least the distance from texel i to the border, along one axis of n texels.
float distance_to_border(double direction, int i, int n) {
  if (direction == 0) return HUGE_VALF;
  const double distance = direction > 0 ? (n - 1 - i) / direction : i / -direction;
  return static_cast<float>(distance * (1 + 1e-6) + 1e-6);
}

HWY_INLINE Packet begin_packet(const HorizonWalk& walk, int x, int y) {
  const HorizonField& field = walk.field;
  const HorizonPath& path = walk.path;
  Packet packet{x, y, {}, {}, {}, 0};
  alignas(64) float slope[kHorizonLanes], border[kHorizonLanes];
  for (int lane = 0; lane < kHorizonLanes; ++lane) {
    const bool used = x + lane < field.width;
    slope[lane] = used ? walk.lowest_slope : HUGE_VALF;
    border[lane] = HUGE_VALF;
    if (!used) border[lane] = 0;
    if (used && field.edge != Edge::kWrap)
      border[lane] = std::min(distance_to_border(path.x, x + lane, field.width),
                              distance_to_border(path.y, y, field.height));
    packet.farthest = std::max(packet.farthest, border[lane]);
  }
  for (size_t p = 0; p < kParts; ++p) {
    packet.here[p] = hn::LoadU(kF, field.at(x, y) + p * kWidth);
    packet.slope[p] = hn::Load(kF, slope + p * kWidth);
    packet.border[p] = hn::Load(kF, border + p * kWidth);
  }
  return packet;
}

// Returns whether heights up to `tall` within a window are below the horizons of all lanes that reach it.
HWY_INLINE bool is_below(const Packet& packet, float tall, const HorizonWindow& window) {
  const V top = broadcast(tall), near = broadcast(window.near), inverse_near = broadcast(window.inverse_near),
          inverse_far = broadcast(window.inverse_far), drop = broadcast(window.drop);
  auto below = hn::Gt(near, packet.border[0]);
  for (size_t p = 0; p < kParts; ++p) {
    const V rise = hn::Sub(top, packet.here[p]);
    // The larger of the two, whatever the sign of the rise.
    const V steepest = hn::Max(hn::Mul(rise, inverse_near), hn::Mul(rise, inverse_far));
    below = hn::Or(hn::Le(hn::Sub(steepest, drop), packet.slope[p]), hn::Gt(near, packet.border[p]));
    if (!hn::AllTrue(kF, below)) return false;
  }
  return true;
}

template <bool kDrops>
HWY_INLINE void walk_piece(const HorizonPath& path, const HorizonPiece& piece,
                           const float* HWY_RESTRICT corner, Packet& packet) {
  V slope[kParts];
  for (size_t p = 0; p < kParts; ++p) slope[p] = packet.slope[p];
  for (uint32_t c = piece.first; c < piece.end; ++c) {
    const HorizonCrossing& crossing = path.crossings[c];
    const V fraction = broadcast(crossing.fraction), inverse = broadcast(crossing.inverse_distance);
    for (size_t p = 0; p < kParts; ++p) {
      const V a = hn::LoadU(kF, corner + crossing.a + p * kWidth),
              b = hn::LoadU(kF, corner + crossing.b + p * kWidth);
      const V rise = hn::Add(hn::Sub(a, packet.here[p]), hn::Mul(fraction, hn::Sub(b, a)));
      V found = hn::Mul(rise, inverse);
      if (kDrops) found = hn::Sub(found, broadcast(crossing.drop));
      slope[p] = hn::Max(slope[p], found);
    }
  }
  for (size_t p = 0; p < kParts; ++p) packet.slope[p] = slope[p];
}

// Returns how many pieces from `piece` on are below the horizons, 0 where the next is not known to be.
HWY_INLINE int pieces_below(const HorizonWalk& walk, const Packet& packet, int piece) {
  const HorizonField& field = walk.field;
  for (size_t level = kWindowLevels; level-- > 0;) {
    const int pieces = kWindowPieces[level];
    if (piece % pieces != 0) continue;
    const HorizonWindow& window = walk.path.windows[level][static_cast<size_t>(piece / pieces)];
    int x = packet.x + window.corner_x, y = packet.y + window.corner_y;
    if (field.edge == Edge::kWrap) {
      x = wrap_index(x, field.width);
      y = wrap_index(y, field.height);
    }
    if (is_below(packet, walk.maxima[level].at(x, y), window)) return pieces;
  }
  return 0;
}

template <bool kDrops>
HWY_INLINE void walk_packet(const HorizonWalk& walk, Packet& packet) {
  const HorizonField& field = walk.field;
  const HorizonPath& path = walk.path;
  const int pieces = static_cast<int>(path.pieces.size());
  for (int piece = 0; piece < pieces;) {
    const HorizonWindow& window = path.windows[0][static_cast<size_t>(piece)];
    if (window.near > packet.farthest || is_below(packet, field.top, window)) return;
    const int skipped = pieces_below(walk, packet, piece);
    piece += skipped;
    if (skipped > 0) continue;
    int x = packet.x + window.corner_x, y = packet.y + window.corner_y;
    if (field.edge == Edge::kWrap) {
      x = wrap_index(x, field.width);
      y = wrap_index(y, field.height);
    }
    walk_piece<kDrops>(path, path.pieces[static_cast<size_t>(piece)], field.at(x, y), packet);
    ++piece;
  }
}

void walk_row(const HorizonWalk& walk, int y, std::span<float> slopes) {
  const V none = broadcast(-HUGE_VALF), least = broadcast(kNoSlope);
  alignas(64) float found[kHorizonLanes];
  for (int x = 0; x < walk.field.width; x += kHorizonLanes) {
    Packet packet = begin_packet(walk, x, y);
    if (walk.drops)
      walk_packet<true>(walk, packet);
    else
      walk_packet<false>(walk, packet);
    for (size_t p = 0; p < kParts; ++p) {
      const V slope = packet.slope[p];
      hn::Store(hn::IfThenElse(hn::Lt(slope, least), none, slope), kF, found + p * kWidth);
    }
    const int count = std::min(kHorizonLanes, walk.field.width - x);
    std::copy_n(found, count, slopes.data() + x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace hemibake
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace hemibake {

HWY_EXPORT(walk_row);

void walk_row(const HorizonWalk& walk, int y, std::span<float> slopes) {
  HWY_DYNAMIC_DISPATCH(walk_row)(walk, y, slopes);
}

}  // namespace hemibake
#endif  // HWY_ONCE
