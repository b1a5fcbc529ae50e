// Reads the directories of a TIFF: which of its images are whole, and the tags that OpenImageIO does not
// show.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace hemibake {

struct TiffPage {
  bool is_reduced = false;        // overview or thumbnail of another (NewSubfileType bit 0)
  bool is_mask = false;           // transparency mask (bit 2)
  std::optional<double> no_data;  // GDAL_NODATA, tag 42113
  int orientation = 1;            // tag 274
};

// Returns the pages of a TIFF or BigTIFF in order; empty where the file is none, or its directories are
// broken. begin: where in the file it stands, bytes.
std::vector<TiffPage> tiff_pages(const std::filesystem::path& path, uint64_t begin = 0);

// Returns the orientation that the EXIF chunk of a WebP names, which OpenImageIO 2.4 leaves out; 1 where it
// has none, or is no WebP.
int webp_orientation(const std::filesystem::path& path);

}  // namespace hemibake
