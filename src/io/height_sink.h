// Collects the heights of a file, texel by texel, and the holes among them.
#pragma once

#include <filesystem>
#include <optional>

#include "io/height_file.h"

namespace hemibake {

// Bytes of a texel while heights are read and made a surface: value, hole and mask; copy; normal.
constexpr double kHeightBytesPerTexel = 6 + 4 + 12;

class HeightSink {
 public:
  // path: for errors. no_data: stored value that stands for no height.
  HeightSink(std::filesystem::path path, int width, int height, std::optional<double> no_data);

  // Sets a height. Throws InputError naming the texel where it is infinite.
  // texel: index right way up; stored: as the file has it; value: in memory; not a number: a hole.
  void put(size_t texel, double stored, float value);

  void mark_hole(size_t texel);

  // Moves heights and holes into `file`. Throws InputError where no texel has a height.
  void finish(HeightFile& file);

 private:
  std::filesystem::path path_;
  std::optional<double> no_data_;
  double tolerance_ = 0;
  Grid<float> values_;
  Grid<uint8_t> holes_;
  size_t hole_count_ = 0;
};

}  // namespace hemibake
