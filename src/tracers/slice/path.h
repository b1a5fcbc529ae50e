// The crossings of straight paths with the edges of the triangles: the same for every receiver that starts at
// the same place of its cell in the same direction.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "tracers/slice/height_pyramid.h"

namespace hemibake {

// Where a path meets an edge: the height there is mix(height[a], height[b], fraction).
struct Crossing {
  int32_t a, b;            // offsets into the plane of heights from the first corner of the segment's window
  float fraction;          // 0..1
  float inverse_distance;  // 1 / horizontal distance from the start, 1/texels
};

// The facet a path lies in before a crossing: its cell relative to the first corner of the segment's window.
struct FacetBefore {
  int8_t column, row;
  bool half;    // false: the facet with the cell's corner (i, j), true: the other (surface/facets.h)
  float along;  // of the crossing, from where the segment begins, texels
};

struct SlicePath {
  glm::dvec2 origin;     // start in its cell, 0..1
  glm::dvec2 direction;  // unit
  double step;           // horizontal length of a segment, texels: it spans kSegmentCells along x or y
  bool starts_in_facet;  // whether the start lies inside a facet, not on a texel centre
};

SlicePath make_slice_path(const glm::dvec2& origin, double azimuth, bool starts_in_facet);

// First corner of the square window over `segments` segments from `segment` on, relative to the start's cell;
// wrapped into the map where it wraps.
glm::ivec2 window_corner(const HeightPyramid& field, const SlicePath& path, int segment, int segments);

// Where a segment begins, from the first corner of its own window, texels.
glm::dvec2 segment_begin(const SlicePath& path, int segment);

// Crossings of a segment, at most: of each family of lines as many as it spans, one more for its overlaps,
// and the one before it.
inline constexpr size_t kMostCrossings = 4 * kSegmentCells + 4;

struct SegmentCrossings {
  uint32_t count;
  std::array<Crossing, kMostCrossings> crossings;
  std::array<FacetBefore, kMostCrossings> facets;
};

// The crossings of one segment by distance, both its ends included, and the facets before them. The first one
// is where the path enters the facet before the second: the crossing before the segment, the start on a
// texel, or, for a start inside a facet, where the path leaves this facet. What a receiver sees begins behind
// it.
void find_crossings(const HeightPyramid& field, const SlicePath& path, int segment, SegmentCrossings& found);

// The nearest segments of all paths of a family.
struct ReadySegments {
  int per_path = 0;
  std::once_flag made;
  std::vector<glm::ivec2>
      corners;  // [(path · per_path + segment) · kSkipLevels + level], where a window begins
  std::vector<uint32_t> first;  // [path · per_path + segment], and the end: into crossings and facets
  std::vector<Crossing> crossings;
  std::vector<FacetBefore> facets;
};

// The paths of one family of receivers (texels, or one half of the cells).
struct SlicePaths {
  int azimuths = 0;
  int azimuths_per_linked = 1;   // links are looked for along every n-th azimuth
  int turns = 0;                 // rotations of the azimuths
  std::vector<SlicePath> paths;  // [turn · azimuths + azimuth]
  std::shared_ptr<ReadySegments> ready;

  size_t path_index(int turn, int azimuth) const {
    return static_cast<size_t>(turn) * static_cast<size_t>(azimuths) + static_cast<size_t>(azimuth);
  }
};

// Found when they are asked for first: families that a map has no receivers of need none.
const ReadySegments& ready_segments(const HeightPyramid& field, const SlicePaths& paths);

}  // namespace hemibake
