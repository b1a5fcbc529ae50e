// The crossings of straight paths with the edges of the triangles: the same for every receiver that starts at
// the same place of its cell in the same direction.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "tracers/slice_field.h"

namespace hemibake {

// Where a path meets an edge: the height there is mix(height[a], height[b], fraction).
struct Crossing {
  int32_t a, b;            // offsets into the plane of heights from the first corner of the segment's window
  float fraction;          // 0..1
  float inverse_distance;  // 1 / horizontal distance from the start, 1/texels
};

// The facet a path lies in before a crossing: its cell relative to the first corner of the segment's window.
struct FacetBefore {
  int16_t column, row;
  int16_t half;  // 0: the facet with the cell's corner (i, j), 1: the other (surface/facets.h)
  float along;   // of the crossing, from where the segment begins, texels
};

// First corners of the windows that begin with a segment, by level, relative to the start's cell; wrapped
// into the map where it wraps. Levels whose windows do not begin with this segment are not used.
struct SegmentWindows {
  glm::ivec2 corner[kSkipLevels];
};

struct SlicePath {
  glm::dvec2 origin;     // start in its cell, 0..1
  glm::dvec2 direction;  // unit
  double step;           // horizontal length of a segment, texels: it spans kSegmentCells along x or y
  bool starts_in_facet;  // whether the start lies inside a facet, not on a texel centre
};

SlicePath make_slice_path(const glm::dvec2& origin, double azimuth, bool starts_in_facet);

SegmentWindows segment_windows(const SliceField& field, const SlicePath& path, int segment);

// Where a segment begins, from the first corner of its window, texels.
glm::dvec2 segment_begin(const SlicePath& path, int segment);

// Appends the crossings of one segment by distance, both its ends included, and the facets before them. The
// first one is where the path enters the facet before the second: the crossing before the segment, the start
// on a texel, or, for a start inside a facet, where the path leaves this facet. What a receiver sees begins
// behind it.
void append_crossings(const SliceField& field, const SlicePath& path, int segment,
                      std::vector<Crossing>& crossings, std::vector<FacetBefore>& facets);

// The paths of one family of receivers (texels, or one half of the cells), with their nearest segments ready.
struct SlicePaths {
  int azimuths = 0;
  int azimuths_per_linked = 1;          // links are looked for along every n-th azimuth
  int turns = 0;                        // rotations of the azimuths
  int ready_segments = 0;               // per path
  std::vector<SlicePath> paths;         // [turn · azimuths + azimuth]
  std::vector<SegmentWindows> windows;  // [path · ready_segments + segment]
  std::vector<uint32_t> first;          // the same, and the end: into crossings and facets
  std::vector<Crossing> crossings;
  std::vector<FacetBefore> facets;

  size_t path_index(int turn, int azimuth) const {
    return static_cast<size_t>(turn) * static_cast<size_t>(azimuths) + static_cast<size_t>(azimuth);
  }
};

// Fills in everything but `paths`, which are there, azimuths · turns of them.
void prepare_segments(const SliceField& field, int ready_segments, SlicePaths& paths);

}  // namespace hemibake
