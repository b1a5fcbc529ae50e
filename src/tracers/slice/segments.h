// The segments of one path after another: those kept ready, and those beyond, found when they are asked for.
#pragma once

#include <array>
#include <span>

#include "tracers/slice/path.h"

namespace hemibake {

struct SegmentView {
  std::span<const Crossing> crossings;
  const FacetBefore* facets;  // one per crossing
};

// For one thread. What it returns is good until the next call.
class SegmentSource {
 public:
  SegmentSource(const HeightPyramid& field, const SlicePaths& paths)
      : field_(field), paths_(paths), ready_(ready_segments(field, paths)) {}

  void begin_path(size_t index) {
    path_ = &paths_.paths[index];
    path_index_ = index;
    first_ready_ = index * static_cast<size_t>(ready_.per_path);
  }
  const SlicePath& path() const { return *path_; }

  // window_corner of the window of a level that begins with `segment`.
  glm::ivec2 corner(int segment, int level) const {
    if (segment >= ready_.per_path) return window_corner(field_, *path_, segment, kSkipSegments[level]);
    return ready_.corners[ready_index(segment) * kSkipLevels + static_cast<size_t>(level)];
  }

  SegmentView crossings(int segment) {
    if (segment < ready_.per_path) {
      const size_t index = ready_index(segment);
      const uint32_t first = ready_.first[index], count = ready_.first[index + 1] - first;
      return {{ready_.crossings.data() + first, count}, ready_.facets.data() + first};
    }
    FarSegment& far = far_segments_[static_cast<size_t>(segment) % far_segments_.size()];
    if (far.path != path_index_ || far.segment != segment) {
      far.path = path_index_;
      far.segment = segment;
      find_crossings(field_, *path_, segment, far.found);
    }
    return {{far.found.crossings.data(), far.found.count}, far.found.facets.data()};
  }

 private:
  struct FarSegment {
    size_t path = 0;
    int segment = -1;
    SegmentCrossings found;
  };

  size_t ready_index(int segment) const { return first_ready_ + static_cast<size_t>(segment); }

  const HeightPyramid& field_;
  const SlicePaths& paths_;
  const ReadySegments& ready_;
  const SlicePath* path_ = nullptr;
  size_t path_index_ = 0, first_ready_ = 0;
  std::array<FarSegment, 128> far_segments_;  // packets near each other ask for the same ones
};

}  // namespace hemibake
