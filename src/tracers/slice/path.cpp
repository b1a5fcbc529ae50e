#include "tracers/slice/path.h"

#include <algorithm>
#include <cmath>

namespace hemibake {
namespace {

// Texels: crossings this close to the ends of a segment belong to both neighbours, so rounding loses none.
constexpr double kOverlap = 1e-9;

// Speed across a family of lines below which a path meets none of them.
constexpr double kParallel = 1e-12;

// Returns ⌊x⌋; std::floor is a function call on plain x86-64.
int floor_to_int(double x) {
  const int toward_zero = static_cast<int>(x);
  return toward_zero - (x < toward_zero ? 1 : 0);
}

// Lines of a family that a segment meets, and one before and after them, at most; rounded up to whole
// vectors.
constexpr int kMostLines = 2 * kSegmentCells + 4;

// Lines of one family that a path meets: x, y or x + y = line, one after the other.
struct LineFamily {
  int step;                      // from one to the next
  int before;                    // the last line before the segment
  double distances[kMostLines];  // to it and to those behind it

  // position: of the segment's beginning across the lines. count: of distances, at most kMostLines.
  LineFamily(double position, double speed, double first_distance, int count) : step(speed > 0 ? 1 : -1) {
    if (std::abs(speed) < kParallel) {
      before = floor_to_int(position) + (step > 0 ? 0 : 1);
      distances[0] = -HUGE_VAL;
      std::fill(distances + 1, distances + count, HUGE_VAL);
      return;
    }
    const double pace = 1 / speed;
    int first = floor_to_int(position) + (step > 0 ? 0 : 1);
    while ((first - position) * pace < first_distance) first += step;
    before = first - step;
    for (int k = 0; k < count; ++k) distances[k] = (line(k) - position) * pace;
  }
  int line(int k) const { return before + k * step; }
  // Returns the line below the path before it meets line k.
  int lower_line(int k) const { return line(k) - (step > 0 ? 1 : 0); }
};

// Returns the first corner of a window as window_corner does, but not wrapped.
glm::ivec2 unwrapped_corner(const SlicePath& path, int segment, int segments) {
  const double near = segment * path.step, far = (segment + segments) * path.step;
  const glm::dvec2 o = path.origin, d = path.direction;
  return {floor_to_int(o.x + (d.x < 0 ? far : near) * d.x), floor_to_int(o.y + (d.y < 0 ? far : near) * d.y)};
}

// Returns i modulo n, for paths of up to 2³¹ texels; faster than a division of integers.
int wrap_far(int i, int n, double inverse_n) {
  const int rest = i - floor_to_int(i * inverse_n) * n;
  return rest < 0 ? rest + n : rest >= n ? rest - n : rest;
}

}  // namespace

SlicePath make_slice_path(const glm::dvec2& origin, double azimuth, bool starts_in_facet) {
  const glm::dvec2 direction(std::cos(azimuth), std::sin(azimuth));
  const double step = kSegmentCells / std::max(std::abs(direction.x), std::abs(direction.y));
  return {origin, direction, step, starts_in_facet};
}

glm::ivec2 window_corner(const HeightPyramid& pyramid, const SlicePath& path, int segment, int segments) {
  const glm::ivec2 corner = unwrapped_corner(path, segment, segments);
  if (!pyramid.wrap) return corner;
  return {wrap_far(corner.x, pyramid.width, pyramid.inverse_width),
          wrap_far(corner.y, pyramid.height, pyramid.inverse_height)};
}

glm::dvec2 segment_begin(const SlicePath& path, int segment) {
  return path.origin + segment * path.step * path.direction - glm::dvec2(unwrapped_corner(path, segment, 1));
}

void find_crossings(const HeightPyramid& pyramid, const SlicePath& path, int segment,
                    SegmentCrossings& found) {
  const double near = segment * path.step, end = path.step + kOverlap;
  const glm::dvec2 d = path.direction, p = segment_begin(path, segment);
  const double first = segment == 0 ? kOverlap : -kOverlap;
  const int pitch = static_cast<int>(pyramid.heights.pitch);
  // Columns, rows and diagonals, whose edges run along y, along x, and from (i, j + 1) to (i + 1, j).
  constexpr int kStraight = kSegmentCells + 4;
  const LineFamily families[3] = {
      {p.x, d.x, first, kStraight}, {p.y, d.y, first, kStraight}, {p.x + p.y, d.x + d.y, first, kMostLines}};
  // From the first corner of the cell before the crossing to `a`, and from there to `b`.
  const int to_a[3] = {d.x > 0 ? 1 : 0, d.y > 0 ? pitch : 0, pitch}, a_to_b[3] = {pitch, 1, 1 - pitch};
  const bool halves[3] = {d.x > 0, d.y > 0, d.x + d.y < 0};

  int next[3] = {1, 1, 1};  // distance of each family
  uint32_t count = 0;
  if (segment > 0) {
    int last = 0;
    for (const int family : {1, 2})
      if (families[family].distances[0] > families[last].distances[0]) last = family;
    next[last] = 0;
  } else if (!path.starts_in_facet) {
    // A texel, or a point of the edge to the right of it, below it, or between the two.
    const int x = static_cast<int>(p.x), y = static_cast<int>(p.y), texel = y * pitch + x;
    const bool right = p.x > x, down = p.y > y;
    const int a = texel + (right && down ? pitch : 0), b = texel + (right ? 1 : down ? pitch : 0);
    found.crossings[count] = {a, b, static_cast<float>(right ? p.x - x : p.y - y), HUGE_VALF};
    found.facets[count++] = {static_cast<int8_t>(x), static_cast<int8_t>(y), 0, 0};
  }
  // Chooses the next family without branches: it follows no pattern.
  int column = next[0], row = next[1], diagonal = next[2];
  for (;;) {
    const double to_column = families[0].distances[column], to_row = families[1].distances[row],
                 to_diagonal = families[2].distances[diagonal];
    const double straight = std::min(to_column, to_row), t = std::min(straight, to_diagonal);
    if (!(t <= end)) break;
    const int is_diagonal = to_diagonal < straight, is_row = (to_row < to_column) & ~is_diagonal,
              is_column = 1 - is_diagonal - is_row, family = is_row + 2 * is_diagonal;
    const int i = families[0].lower_line(column), straight_j = families[1].lower_line(row);
    const int diagonal_j = families[2].line(diagonal) - i - 1;
    const int j = straight_j + is_diagonal * (diagonal_j - straight_j);
    const double x = p.x + t * d.x - i, y = p.y + t * d.y - j;
    const int a = j * pitch + i + to_a[family];
    found.crossings[count] = {a, a + a_to_b[family], static_cast<float>(is_column * y + (1 - is_column) * x),
                              static_cast<float>(1 / (near + t))};
    found.facets[count++] = {static_cast<int8_t>(i), static_cast<int8_t>(j), halves[family],
                             static_cast<float>(t)};
    column += is_column;
    row += is_row;
    diagonal += is_diagonal;
  }
  found.count = count;
}

const CachedSegments& cached_segments(const HeightPyramid& pyramid, const SlicePaths& paths) {
  CachedSegments& cache = *paths.cache;
  std::call_once(cache.made, [&] {
    SegmentCrossings found;
    cache.first.push_back(0);
    for (const SlicePath& path : paths.paths) {
      for (int segment = 0; segment < cache.per_path; ++segment) {
        for (int level = 0; level < kMipLevels; ++level) {
          const int segments = kMipSegments[level];
          cache.corners.push_back(segment % segments == 0 ? window_corner(pyramid, path, segment, segments)
                                                          : glm::ivec2(0));
        }
        find_crossings(pyramid, path, segment, found);
        cache.crossings.insert(cache.crossings.end(), found.crossings.begin(),
                               found.crossings.begin() + found.count);
        cache.facets.insert(cache.facets.end(), found.facets.begin(), found.facets.begin() + found.count);
        cache.first.push_back(static_cast<uint32_t>(cache.crossings.size()));
      }
    }
    cache.crossings.shrink_to_fit();
    cache.facets.shrink_to_fit();
  });
  return cache;
}

}  // namespace hemibake
