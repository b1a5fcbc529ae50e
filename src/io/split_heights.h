// Joins heights that are split over channels of 8 bits, and recognises them.
#pragma once

#include <cstdint>

#include "io/height_file.h"

namespace hemibake {

// Returns the joined value: metres (Terrarium: R·256 + G + B/256 − 32768; Mapbox: (65536 R + 256 G + B)/10 −
// 10000), or 256 R + G of 0..65535. Sources: tilezen/joerd formats.md; Mapbox Terrain-RGB.
// rgb: 0..255 each.
double join_split_height(SplitEncoding encoding, double r, double g, double b);

// Tells from neighbouring texels whether `lower` is a sawtooth that counts through while `upper` steps.
class SplitDetector {
 public:
  // Adds two neighbours: the steps from one to the next, each −255..255.
  void add(int upper_step, int lower_step);

  // Returns whether steps of the upper channel come with the opposite step of the lower, or, on steep
  // heights, the lower is noise on a smooth upper.
  bool is_split() const;

 private:
  uint64_t unit_steps_ = 0, wrapped_steps_ = 0;         // of ±1 in `upper`, and those where `lower` wraps
  uint64_t count_ = 0, upper_sum_ = 0, lower_sum_ = 0;  // of absolute steps
};

}  // namespace hemibake
