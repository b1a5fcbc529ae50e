// Walks packets of receivers along their paths, with the vector instructions of the machine it runs on.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tracers/slice/height_pyramid.h"
#include "tracers/slice/path.h"

namespace hemibake {

template <class T>
using LaneArray = std::array<T, kSliceLanes>;

// Most hits for links of a slice that holds the mean share of its receiver's hemisphere.
inline constexpr int kHitsPerSlice = 8;

// Receivers side by side: lane l starts in the cell (x + l, y).
struct SlicePacket {
  int x = 0, y = 0;
  uint32_t lanes = 0xffff;                // bits; the others are not walked
  int turn = 0;                           // which rotation of the azimuths
  float corner = 0;                       // of the cell, 0: (x, y), 1: (x + 1, y + 1)
  LaneArray<float> base{};                // height there, texels
  LaneArray<float> plane_x{}, plane_y{};  // slopes of the plane through it on which the start lies
  LaneArray<float> rim_x{}, rim_y{};      // slopes of the plane normal to the receiver's normal
  // For links: hits per unit of weight of a slice, and where its first one lies, 0..1 of the way to a second.
  LaneArray<float> hits_per_weight{}, place{};
};

// ∫ over a part of every slice of 1 and of the direction d, in solid angle times azimuths / 2π.
struct SliceSums {
  LaneArray<double> uniform{}, x{}, y{}, z{};
};

// A piece of facet that a receiver sees along one azimuth, between two slopes from its start.
struct VisibleInterval {
  uint32_t facet;
  float weight;            // ∫ cosine to the receiver's normal, over normal.z, as in SliceSums
  float low, high;         // slopes
  float inverse_distance;  // 1 / horizontal distance of its end at slope `high`, 1/texels
  uint32_t azimuth;
};

// A point of a facet that a receiver sees at one slope of an azimuth, standing for the slopes around it.
struct SliceHit {
  uint32_t facet;
  float weight;    // of all hits of the receiver; a walk finds hits that weigh alike
  float u, v;      // where on the facet (surface/facets.h); to rounding within 0..1
  float distance;  // along the ray, texels
};

// What every lane of a packet sees.
struct PacketView {
  SliceSums hemisphere;                   // everything above the plane normal to the receiver's normal
  SliceSums sky;                          // what of it is sky
  LaneArray<std::vector<SliceHit>> hits;  // by azimuth, then by distance
  LaneArray<std::vector<VisibleInterval>> stretches;  // the same
  LaneArray<uint32_t> truncated{};
};

// ∫ cosine to the normal of a lane's receiver, over normal.z, of what the sums add up.
inline double cosine_sum(const SlicePacket& packet, const SliceSums& sums, size_t lane) {
  return -static_cast<double>(packet.rim_x[lane]) * sums.x[lane] -
         static_cast<double>(packet.rim_y[lane]) * sums.y[lane] + sums.z[lane];
}

// Keeps the memory of hits and stretches.
inline void clear(PacketView& view) {
  view.hemisphere = view.sky = {};
  view.truncated = {};
  for (auto& hits : view.hits) hits.clear();
  for (auto& stretches : view.stretches) stretches.clear();
}

// What a walk is for, besides the sky: a sample of what is seen below the horizon, or all of it.
enum class Query { kHorizon, kSampledHits, kAllIntervals };

struct WalkOptions {
  Query what = Query::kHorizon;
  int azimuths_per_linked = 1;  // hits are sampled along every n-th azimuth only
  double max_distance =
      std::numeric_limits<double>::infinity();  // horizontal, texels: no need to go on beyond
};

// Adds to the views of the packets what they see. Packets near each other are best given together.
void walk_packets(const HeightPyramid& field, const SlicePaths& paths, const WalkOptions& options,
                  std::span<const SlicePacket> packets, std::span<PacketView> views);

}  // namespace hemibake
