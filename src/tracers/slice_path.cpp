#include "tracers/slice_path.h"

#include <algorithm>
#include <cmath>

namespace hemibake {
namespace {

// Crossings this close to the ends of a segment, in texels, belong to both neighbours: none is lost to
// rounding.
constexpr double kOverlap = 1e-9;

// A path this nearly parallel to a family of lines meets none of it in any distance that is followed.
constexpr double kParallel = 1e-12;

// std::floor is a function call on plain x86-64.
int floor_to_int(double x) {
  const int toward_zero = static_cast<int>(x);
  return toward_zero - (x < toward_zero ? 1 : 0);
}

// The lines of one family that a path meets: x, y or x + y = line, one after the other.
struct LineFamily {
  double position, pace;  // of the path across the lines; pace: its length from one to the next
  int line, step;         // the next one
  double distance;        // to it

  LineFamily(double p, double speed, double first_distance) : position(p), step(speed > 0 ? 1 : -1) {
    const bool parallel = std::abs(speed) < kParallel;
    pace = parallel ? HUGE_VAL : 1 / speed;
    line = floor_to_int(p) + (parallel == (speed > 0) ? 1 : 0);
    for (distance = parallel ? HUGE_VAL : to_line(); distance < first_distance;) move(1);
  }
  double to_line() const { return (line - position) * pace; }
  void move(int lines) {
    line += lines * step;
    distance = std::isinf(pace) ? HUGE_VAL : to_line();
  }
  // The path lies between this line and the next higher one.
  int lower_line() const { return step > 0 ? line - 1 : line; }
  // The line before the next one.
  LineFamily back() const {
    LineFamily before = *this;
    before.move(-1);
    if (before.distance == HUGE_VAL) before.distance = -HUGE_VAL;
    return before;
  }
};

// First corner of the square window over `segments` segments from `segment` on, relative to the start's cell.
glm::ivec2 window_corner(const SlicePath& path, int segment, int segments) {
  const double near = segment * path.step, far = (segment + segments) * path.step;
  const glm::dvec2 o = path.origin, d = path.direction;
  return {floor_to_int(o.x + std::min(near * d.x, far * d.x)),
          floor_to_int(o.y + std::min(near * d.y, far * d.y))};
}

}  // namespace

SlicePath make_slice_path(const glm::dvec2& origin, double azimuth, bool starts_in_facet) {
  const glm::dvec2 direction(std::cos(azimuth), std::sin(azimuth));
  const double step = kSegmentCells / std::max(std::abs(direction.x), std::abs(direction.y));
  return {origin, direction, step, starts_in_facet};
}

SegmentWindows segment_windows(const SliceField& field, const SlicePath& path, int segment) {
  SegmentWindows windows;
  for (int level = 0; level < kSkipLevels; ++level) {
    glm::ivec2& corner = windows.corner[level];
    if (level > 0 && kSkipSegments[level] == kSkipSegments[level - 1]) {
      corner = windows.corner[level - 1];
      continue;
    }
    if (segment % kSkipSegments[level] != 0) break;
    corner = window_corner(path, segment, kSkipSegments[level]);
    if (field.wrap) corner = {wrap_index(corner.x, field.width), wrap_index(corner.y, field.height)};
  }
  return windows;
}

glm::dvec2 segment_begin(const SlicePath& path, int segment) {
  return path.origin + segment * path.step * path.direction - glm::dvec2(window_corner(path, segment, 1));
}

void append_crossings(const SliceField& field, const SlicePath& path, int segment,
                      std::vector<Crossing>& crossings, std::vector<FacetBefore>& facets) {
  const double near = segment * path.step;
  const glm::dvec2 d = path.direction, p = segment_begin(path, segment);
  const double first = segment == 0 ? kOverlap : -kOverlap;
  LineFamily columns(p.x, d.x, first), rows(p.y, d.y, first), diagonals(p.x + p.y, d.x + d.y, first);
  const int pitch = static_cast<int>(field.heights.pitch);

  // The crossing with the given line of a family, t ahead.
  const auto append = [&](const LineFamily& family, int line, double t) {
    const double x = p.x + t * d.x, y = p.y + t * d.y;
    // Edges by family: along y, along x, and the diagonal from (i, j + 1) to (i + 1, j).
    int i = columns.lower_line(), j = rows.lower_line();
    Crossing crossing{0, 0, 0, static_cast<float>(1 / (near + t))};
    FacetBefore facet{0, 0, 0, static_cast<float>(t)};
    if (&family == &columns) {
      i = line;
      crossing.a = j * pitch + i;
      crossing.b = crossing.a + pitch;
      crossing.fraction = static_cast<float>(y - j);
      facet.half = d.x > 0;
      if (d.x > 0) --i;
    } else if (&family == &rows) {
      j = line;
      crossing.a = j * pitch + i;
      crossing.b = crossing.a + 1;
      crossing.fraction = static_cast<float>(x - i);
      facet.half = d.y > 0;
      if (d.y > 0) --j;
    } else {
      j = line - i - 1;
      crossing.a = (j + 1) * pitch + i;
      crossing.b = j * pitch + i + 1;
      crossing.fraction = static_cast<float>(x - i);
      facet.half = d.x + d.y < 0;
    }
    facet.column = static_cast<int16_t>(i);
    facet.row = static_cast<int16_t>(j);
    crossings.push_back(crossing);
    facets.push_back(facet);
  };

  if (segment > 0) {
    const LineFamily* last = &columns;
    for (const LineFamily* family : {&rows, &diagonals})
      if (family->back().distance > last->back().distance) last = family;
    append(*last, last->back().line, last->back().distance);
  } else if (!path.starts_in_facet) {
    const int32_t texel = static_cast<int32_t>(p.y) * pitch + static_cast<int32_t>(p.x);
    crossings.push_back({texel, texel, 0, HUGE_VALF});
    facets.push_back({static_cast<int16_t>(p.x), static_cast<int16_t>(p.y), 0, 0});
  }
  for (;;) {
    LineFamily* next = &columns;
    for (LineFamily* family : {&rows, &diagonals})
      if (family->distance < next->distance) next = family;
    if (!(next->distance <= path.step + kOverlap)) return;
    append(*next, next->line, next->distance);
    next->move(1);
  }
}

void prepare_segments(const SliceField& field, int ready_segments, SlicePaths& paths) {
  paths.ready_segments = ready_segments;
  paths.first.push_back(0);
  for (const SlicePath& path : paths.paths) {
    for (int segment = 0; segment < ready_segments; ++segment) {
      paths.windows.push_back(segment_windows(field, path, segment));
      append_crossings(field, path, segment, paths.crossings, paths.facets);
      paths.first.push_back(static_cast<uint32_t>(paths.crossings.size()));
    }
  }
}

}  // namespace hemibake
