// Follows packets of receivers along their paths, with the vector instructions of the machine it runs on.
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

// Hits, at most, of a slice that holds the mean share of its receiver's hemisphere.
inline constexpr int kHitsPerSlice = 8;
// Receivers that look from one start, at most.
inline constexpr uint32_t kMostReceivers = 6;

// Starts side by side: lane l starts in the cell (x + l, y). One receiver or several look from each, which
// differ in their tangent planes: the facets around a texel, or the two beside an edge.
struct SlicePacket {
  int x = 0, y = 0;
  int rotation = 0;                       // of the azimuths
  float corner = 0;                       // of the cell, 0: (x, y), 1: (x + 1, y + 1)
  LaneArray<float> base{};                // height there, texels
  LaneArray<float> plane_x{}, plane_y{};  // slopes of the plane through it on which the start lies
  uint32_t first_receiver = 0;            // in the list that comes with packets
  uint32_t receivers = 1;
};

// The receivers of one kind of a packet.
struct SliceReceivers {
  uint32_t lanes = 0xffff;  // bits of the lanes that are traced
  // Slopes of the tangent plane: the plane normal to the receiver's normal bounds its hemisphere.
  LaneArray<float> tangent_slope_x{}, tangent_slope_y{};
  LaneArray<float> hits_per_weight{};  // hits per unit of weight of a slice
  LaneArray<float> hit_offset{};       // of the first hit, 0..1 of the way to the second
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

// A point of a facet that a receiver sees at one slope of an azimuth; a sample of the slopes around it.
struct SliceHit {
  uint32_t facet;
  float weight;    // relative to the receiver's other hits
  float u, v;      // on the facet (surface/facets.h); to rounding within 0..1
  float distance;  // along the ray, texels
};

// View of the receivers of one kind of a packet, lane by lane.
struct PacketView {
  SliceSums hemisphere;                               // everything above the tangent plane
  SliceSums sky;                                      // the part of it that is sky
  LaneArray<std::vector<SliceHit>> hits;              // by azimuth, then by distance
  LaneArray<std::vector<VisibleInterval>> intervals;  // by azimuth, then by distance
  LaneArray<uint32_t> truncated{};
};

// Returns ∫ cosine to the normal of a lane's receiver, over normal.z, from the sums over 1 and d.
inline double cosine_sum(const SliceReceivers& receivers, const SliceSums& sums, size_t lane) {
  return -static_cast<double>(receivers.tangent_slope_x[lane]) * sums.x[lane] -
         static_cast<double>(receivers.tangent_slope_y[lane]) * sums.y[lane] + sums.z[lane];
}

// Empties a view, keeping the memory of hits and intervals.
inline void clear(PacketView& view) {
  view.hemisphere = view.sky = {};
  view.truncated = {};
  for (auto& hits : view.hits) hits.clear();
  for (auto& intervals : view.intervals) intervals.clear();
}

// Wanted of a traversal: the sky alone, or also a sample of the hits below the horizon, or all intervals.
enum class Query { kHorizon, kSampledHits, kAllIntervals };

struct TraversalOptions {
  Query query = Query::kHorizon;
  int hit_azimuth_stride = 1;  // hits are sampled along every n-th azimuth only, of each receiver others
  double max_distance = std::numeric_limits<double>::infinity();  // horizontal, texels: paths may end there
  double least_distance = 0;  // horizontal, texels: nearer hits count as so far away
};

// Packets and their receivers.
struct SlicePackets {
  std::span<const SlicePacket> packets;
  std::span<const SliceReceivers> receivers;
};

// Adds the view of all receivers to `views`, one per element of receivers. Neighbouring packets are best
// given together.
void traverse_packets(const HeightPyramid& pyramid, const SlicePaths& paths, const TraversalOptions& options,
                      const SlicePackets& packets, std::span<PacketView> views);

}  // namespace hemibake
