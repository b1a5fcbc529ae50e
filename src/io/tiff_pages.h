// Reads the directories of a TIFF: which of its images are whole, and the tags that OpenImageIO does not
// show.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace hemibake {

struct TiffPage {
  bool is_reduced = false;        // overview or thumbnail of another (NewSubfileType bit 0)
  bool is_mask = false;           // transparency mask (bit 2)
  std::optional<double> no_data;  // GDAL_NODATA, tag 42113
};

// Returns the pages of a TIFF or BigTIFF in order; empty where the file is none, or its directories are
// broken.
std::vector<TiffPage> tiff_pages(const std::filesystem::path& path);

}  // namespace hemibake
