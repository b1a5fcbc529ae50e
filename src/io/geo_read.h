// Reads terrain through GDAL: GeoTIFF, SRTM, Arc/Info and BIL grids, VRT, netCDF and their kind.
#pragma once

#include <filesystem>
#include <optional>

#include "io/height_file.h"

namespace hemibake {

// Reads terrain into metres, north up: the band's scale, offset and unit are applied, its NoData and its mask
// are holes, as values that are not finite. Overviews are ignored. Returns
// nothing for a file that is no terrain (is_geo_file), that options say to read otherwise (raw, encoding,
// part), and for a TIFF without coordinates. options.channel: a band's number from 1 or its description, or a
// variable of netCDF; empty: the first band. Throws InputError naming the file where GDAL cannot be loaded or
// cannot read it; where it is in degrees or turned, with the command that helps; where it is a picture, holds
// several variables, has a unit that is no length, no height at all, or more than kMaxTexels.
std::optional<HeightFile> read_geo_file(const std::filesystem::path& path, const HeightFileOptions& options);

}  // namespace hemibake
