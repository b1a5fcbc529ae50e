// The segments of one path after another: those kept ready, and those beyond, found when they are asked for.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tracers/slice_path.h"

namespace hemibake {

struct SegmentView {
  std::span<const Crossing> crossings;
  const FacetBefore* facets;  // one per crossing
};

// For one thread. What it returns is good until the next call.
class SegmentSource {
 public:
  SegmentSource(const SliceField& field, const SlicePaths& paths) : field_(field), paths_(paths) {}

  void begin_path(size_t index) {
    path_ = &paths_.paths[index];
    ready_ = index * static_cast<size_t>(paths_.ready_segments);
    for (FarSegment& far : far_segments_) far.segment = -1;
  }
  const SlicePath& path() const { return *path_; }

  const SegmentWindows& windows(int segment) {
    return segment < paths_.ready_segments ? paths_.windows[ready_ + static_cast<size_t>(segment)]
                                           : far_segment(segment).windows;
  }

  SegmentView crossings(int segment) {
    if (segment < paths_.ready_segments) {
      const size_t index = ready_ + static_cast<size_t>(segment);
      const uint32_t first = paths_.first[index], count = paths_.first[index + 1] - first;
      return {{paths_.crossings.data() + first, count}, paths_.facets.data() + first};
    }
    FarSegment& far = far_segment(segment);
    if (far.crossings.empty()) append_crossings(field_, *path_, segment, far.crossings, far.facets);
    return {far.crossings, far.facets.data()};
  }

 private:
  struct FarSegment {
    int segment = -1;
    SegmentWindows windows;
    std::vector<Crossing> crossings;  // empty until asked for
    std::vector<FacetBefore> facets;
  };

  FarSegment& far_segment(int segment) {
    FarSegment& far = far_segments_[static_cast<size_t>(segment) % far_segments_.size()];
    if (far.segment != segment) {
      far.segment = segment;
      far.windows = segment_windows(field_, *path_, segment);
      far.crossings.clear();
      far.facets.clear();
    }
    return far;
  }

  const SliceField& field_;
  const SlicePaths& paths_;
  const SlicePath* path_ = nullptr;
  size_t ready_ = 0;
  std::array<FarSegment, 128> far_segments_;  // packets near each other ask for the same ones
};

}  // namespace hemibake
