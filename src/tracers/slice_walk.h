// Walks packets of receivers along their paths, with the vector instructions of the machine it runs on.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tracers/slice_field.h"
#include "tracers/slice_path.h"

namespace hemibake {

template <class T>
using LaneArray = std::array<T, kSliceLanes>;

// The paths of one family of receivers (texels, or one half of the cells), azimuth by azimuth: `azimuths` for each of
// `turns` rotations. The nearest segments of every path are kept ready.
struct SlicePaths {
  int azimuths = 0;
  int turns = 0;
  int ready_segments = 0;
  bool starts_in_facet = false;
  std::vector<SlicePath> paths;    // [turn · azimuths + azimuth]
  std::vector<Segment> segments;  // [path · ready_segments + segment]
};

// Receivers side by side: lane l starts in the cell (x + l, y).
struct SlicePacket {
  int x = 0, y = 0;
  int lanes = kSliceLanes;                        // the others are not walked
  float corner = 0;                       // of the cell, 0: (x, y), 1: (x + 1, y + 1)
  LaneArray<float> base{};                // height there, texels
  LaneArray<float> plane_x{}, plane_y{};  // slopes of the plane through it on which the start lies
  LaneArray<float> rim_x{}, rim_y{};      // slopes of the plane normal to the receiver's normal
};

// ∫ over a part of every slice of 1 and of the direction d, in solid angle times azimuths / 2π.
struct SliceSums {
  LaneArray<double> uniform{}, x{}, y{}, z{};
};

struct PacketView {
  SliceSums hemisphere;  // the half-space above the normal's plane
  SliceSums sky;         // what of it is sky
  LaneArray<uint32_t> cut_short{};
};

// What every lane of the packet sees, links left aside.
PacketView walk_horizons(const SliceField& field, const SlicePaths& paths, int turn, const SlicePacket& packet);

}  // namespace hemibake
