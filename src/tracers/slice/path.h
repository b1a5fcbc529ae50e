// Finds the crossings of straight paths with the edges of the triangles: the same for every receiver that
// starts at the same place of its cell in the same direction.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "tracers/slice/height_pyramid.h"

namespace hemibake {

// Crossing of a path with an edge: the height there is mix(height[a], height[b], fraction).
struct Crossing {
  int32_t a, b;            // offsets into the plane of heights from the first corner of the segment's window
  float fraction;          // 0..1
  float inverse_distance;  // 1 / horizontal distance from the start, 1/texels
};

// Facet of a path before a crossing: its cell relative to the first corner of the segment's window.
struct FacetBefore {
  int8_t column, row;
  bool half;    // false: the facet with the cell's corner (i, j), true: the other (surface/facets.h)
  float along;  // of the crossing, from where the segment begins, texels
};

struct SlicePath {
  glm::dvec2 origin;     // start in its cell, 0..1
  glm::dvec2 direction;  // unit
  double step;           // horizontal length of a segment, texels: it spans kSegmentCells along x or y
  bool starts_in_facet;  // the start lies inside a facet, not on a texel centre or an edge
};

// Makes a path. origin: in its cell, 0..1. azimuth: radians. starts_in_facet: not on a texel centre or an
// edge.
SlicePath make_slice_path(const glm::dvec2& origin, double azimuth, bool starts_in_facet);

// Returns the first corner of the square window over `segments` segments from `segment` on, relative to the
// start's cell; wrapped into the map where it wraps.
glm::ivec2 window_corner(const HeightPyramid& pyramid, const SlicePath& path, int segment, int segments);

// Returns the beginning of a segment from the first corner of its own window, texels.
glm::dvec2 segment_begin(const SlicePath& path, int segment);

// Crossings of a segment, at most: lines of each family that it spans, one more for its overlaps, and the one
// before it.
inline constexpr size_t kMostCrossings = 4 * kSegmentCells + 4;

struct SegmentCrossings {
  uint32_t count;
  std::array<Crossing, kMostCrossings> crossings;
  std::array<FacetBefore, kMostCrossings> facets;
};

// Finds the crossings of one segment by distance, both ends included, and the facets before them. At the
// first crossing the path enters the facet before the second: the crossing before the segment, the start on a
// texel or an edge, or, for a start inside a facet, the crossing where the path leaves it. The view begins
// behind it.
void find_crossings(const HeightPyramid& pyramid, const SlicePath& path, int segment,
                    SegmentCrossings& found);

// Nearest segments of all paths of a family.
struct CachedSegments {
  int per_path = 0;
  std::once_flag made;
  std::vector<glm::ivec2> corners;  // of windows, [(path · per_path + segment) · kMipLevels + level]
  std::vector<uint32_t> first;      // [path · per_path + segment], and the end: into crossings and facets
  std::vector<Crossing> crossings;
  std::vector<FacetBefore> facets;
};

// Paths of one family of receivers: the texels, or one node of either half of the cells.
struct SlicePaths {
  int azimuths = 0;
  int hit_azimuth_stride = 1;    // hits are sampled along every n-th azimuth only
  double least_distance = 0;     // texels: nearer hits count as so far away
  int rotations = 0;             // rotations of the azimuths
  std::vector<SlicePath> paths;  // [rotation · azimuths + azimuth]
  std::shared_ptr<CachedSegments> cache;

  size_t path_index(int rotation, int azimuth) const {
    return static_cast<size_t>(rotation) * static_cast<size_t>(azimuths) + static_cast<size_t>(azimuth);
  }
};

// Returns a family's cached segments, finding them on the first call: a map may have no such receivers.
const CachedSegments& cached_segments(const HeightPyramid& pyramid, const SlicePaths& paths);

}  // namespace hemibake
