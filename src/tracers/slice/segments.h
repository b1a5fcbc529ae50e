// Hands out the segments of one path after another: cached ones, and those beyond, found when asked for.
#pragma once

#include <array>
#include <span>

#include "tracers/slice/path.h"

namespace hemibake {

struct SegmentView {
  std::span<const Crossing> crossings;
  const FacetBefore* facets;  // one per crossing
};

// For one thread. Returned segments are valid until the next call.
class SegmentSource {
 public:
  SegmentSource(const HeightPyramid& pyramid, const SlicePaths& paths)
      : pyramid_(pyramid), paths_(paths), cache_(cached_segments(pyramid, paths)) {}

  void begin_path(size_t index) {
    path_ = &paths_.paths[index];
    path_index_ = index;
    first_cached_ = index * static_cast<size_t>(cache_.per_path);
  }
  const SlicePath& path() const { return *path_; }

  // Returns the window_corner of a level's window that begins with `segment`.
  glm::ivec2 corner(int segment, int level) const {
    if (segment >= cache_.per_path) return window_corner(pyramid_, *path_, segment, kMipSegments[level]);
    return cache_.corners[cached_index(segment) * kMipLevels + static_cast<size_t>(level)];
  }

  SegmentView crossings(int segment) {
    if (segment < cache_.per_path) {
      const size_t index = cached_index(segment);
      const uint32_t first = cache_.first[index], count = cache_.first[index + 1] - first;
      return {{cache_.crossings.data() + first, count}, cache_.facets.data() + first};
    }
    FarSegment& far = far_segments_[static_cast<size_t>(segment) % far_segments_.size()];
    if (far.path != path_index_ || far.segment != segment) {
      far.path = path_index_;
      far.segment = segment;
      find_crossings(pyramid_, *path_, segment, far.found);
    }
    return {{far.found.crossings.data(), far.found.count}, far.found.facets.data()};
  }

 private:
  struct FarSegment {
    size_t path = 0;
    int segment = -1;
    SegmentCrossings found;
  };

  size_t cached_index(int segment) const { return first_cached_ + static_cast<size_t>(segment); }

  const HeightPyramid& pyramid_;
  const SlicePaths& paths_;
  const CachedSegments& cache_;
  const SlicePath* path_ = nullptr;
  size_t path_index_ = 0, first_cached_ = 0;
  std::array<FarSegment, 128> far_segments_;  // neighbouring packets share them
};

}  // namespace hemibake
