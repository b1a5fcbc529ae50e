// The crossings of a straight path with the edges of the triangles: the same for every receiver that starts at the
// same place of its cell in the same direction.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <vector>

#include "tracers/slice_field.h"

namespace hemibake {

// Where a path meets an edge: its height is mix(height[a], height[b], fraction).
struct Crossing {
  int32_t a, b;            // offsets into a plane of the field from the corner of the segment's window
  float fraction;          // 0..1
  float inverse_distance;  // 1 / horizontal distance from the start, 1/texels
};

// The facet a path lies in before a crossing: cell relative to the corner of the segment's window.
struct FacetBefore {
  int16_t column, row;
  int16_t half;  // 0: the facet with the cell's corner (i, j), 1: the other (surface/facets.h)
};

struct Segment {
  std::vector<Crossing> crossings;  // by distance
  std::vector<FacetBefore> facets;  // one per crossing
};

struct SlicePath {
  glm::dvec2 origin;     // start in its cell, 0..1
  glm::dvec2 direction;  // unit
  double step;           // horizontal length of a segment, texels: it spans kSegmentCells along x or y

  // First corner of the square window over `segments` segments from `segment` on, relative to the start's cell.
  glm::ivec2 window(int segment, int segments) const;
};

SlicePath make_slice_path(const glm::dvec2& origin, double azimuth);

// Replaces `out` by the crossings of one segment, both its ends included; not the start itself. The first segment of a
// path that starts inside a facet leaves out where it leaves this facet: it lies in the facet's plane.
void find_crossings(const SlicePath& path, int segment, bool starts_in_facet, size_t pitch, Segment& out);

}  // namespace hemibake
