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

// The lines of one family that a path meets: x, y or x + y = line, one after the other.
struct LineFamily {
  double position, speed;  // of the path across the lines
  int line;                // the next one
  double distance;         // to it

  LineFamily(double p, double s, double first_distance) : position(p), speed(s) {
    line = static_cast<int>(s > 0 ? std::floor(p) : std::ceil(p));
    for (distance = to_line(); distance < first_distance;) move(1);
  }
  double to_line() const { return std::abs(speed) < kParallel ? HUGE_VAL : (line - position) / speed; }
  void move(int lines) {
    line += speed > 0 ? lines : -lines;
    distance = to_line();
  }
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
  return {static_cast<int>(std::floor(o.x + std::min(near * d.x, far * d.x))),
          static_cast<int>(std::floor(o.y + std::min(near * d.y, far * d.y)))};
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
    int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const float inverse = static_cast<float>(1 / (near + t)), along = static_cast<float>(t);
    if (&family == &columns) {
      i = line;
      crossings.push_back({j * pitch + i, (j + 1) * pitch + i, static_cast<float>(y - j), inverse});
      facets.push_back({static_cast<int16_t>(d.x > 0 ? i - 1 : i), static_cast<int16_t>(j), d.x > 0, along});
    } else if (&family == &rows) {
      j = line;
      crossings.push_back({j * pitch + i, j * pitch + i + 1, static_cast<float>(x - i), inverse});
      facets.push_back({static_cast<int16_t>(i), static_cast<int16_t>(d.y > 0 ? j - 1 : j), d.y > 0, along});
    } else {
      j = line - i - 1;
      crossings.push_back({(j + 1) * pitch + i, j * pitch + i + 1, static_cast<float>(x - i), inverse});
      facets.push_back({static_cast<int16_t>(i), static_cast<int16_t>(j), d.x + d.y < 0, along});
    }
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
