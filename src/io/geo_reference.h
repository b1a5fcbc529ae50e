// Place of a raster that GDAL has open, and the command that brings one into metres.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "io/gdal_library.h"
#include "io/height_file.h"

namespace hemibake {

// A raster that GDAL has open.
struct GeoRaster {
  const GdalLibrary& gdal;
  GDALDatasetH dataset;
  const std::filesystem::path& path;
  int width, height;
};

// Returns where a raster lies, no_data and heights left to the caller; none: it has no coordinates. Checks
// the true size of texels against the coordinates and puts a scale that is the same in x and y into
// metres_per_unit, as of the Mercator projection. Throws InputError, with the command that helps, for
// coordinates in degrees, turned or mirrored rows, and texels that differ in true size.
std::optional<GeoPlace> place_of(const GeoRaster& raster);

// Returns the commands that bring a raster into metres, north up, without texels beyond its border where that
// can be. assumed_crs: for a raster that names none; empty: none.
std::string metres_command(const GeoRaster& raster, const std::string& assumed_crs = "");

}  // namespace hemibake
