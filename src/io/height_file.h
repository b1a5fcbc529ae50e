// Reads a height map with everything its file says about what the values mean.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"

namespace hemibake {

// Heights that are split over channels of 8 bits: map tiles of Terrarium and Mapbox (metres), or 16 bits with
// the upper 8 in red and the lower in green.
enum class SplitEncoding { kNone, kTerrarium, kMapbox, kRg16 };

// The part of an EXR that is read: the window that is shown, or the one that has data.
enum class ImageWindow { kDisplay, kData };

// What the user says about a file. Everything is optional.
struct HeightFileOptions {
  std::string channel;  // name (any case where only one matches) or index; empty: the only one, green, or Y
  std::optional<int> part;  // of a file of several images, from 0
  ImageWindow window = ImageWindow::kDisplay;
  SplitEncoding encoding = SplitEncoding::kNone;
  std::string raw;                // "WxH:TYPE" of a file without a header; TYPE: u8, u16le, i16be, f32le, …
  std::optional<double> no_data;  // stored value that stands for no height; absent: what the file says
};

// Place of a raster on the earth.
struct GeoPlace {
  std::string crs;                    // WKT; empty: the file names none
  std::array<double, 6> transform{};  // of texel corners, as GDAL orders them: x = t0 + i t1 + j t2
  std::optional<double> no_data;      // as the file names it
  double metres_per_unit = 1;         // of the horizontal coordinates
};

// A height map as its file holds it, right way up.
struct HeightFile {
  Grid<float> values;       // integers over the largest value of their type; floats and metres as stored
  Grid<uint8_t> holes;      // 1: no height there (its value is 0); empty: none
  std::string format;       // "PNG", "GeoTIFF"
  std::string sample_type;  // "16-bit integers", "32-bit floats"
  std::vector<std::string> channels;
  std::string channel;      // taken, or the encoding that joins several
  double full_scale = 1;    // stored value that is 1 here: 65535; 1 where values are as stored
  bool in_metres = false;   // by the format: terrain and its tiles
  int orientation = 1;      // as EXIF counts them; applied
  double pixel_aspect = 1;  // width of a texel over its height
  std::optional<GeoPlace> place;
  std::string doubt;  // about the meaning of its channels, option names in braces; empty: none
};

// Reads the heights of a file. Throws InputError naming the file as io/image_io.h says, and for options that
// do not fit it.
HeightFile read_height_file(const std::filesystem::path& path, const HeightFileOptions& options);

}  // namespace hemibake
