// The band of a raster that holds the heights, and what it says about them.
#pragma once

#include <string>
#include <vector>

#include "io/geo_reference.h"

namespace hemibake {

struct GeoBand {
  GDALRasterBandH handle = nullptr;
  GDALRasterBandH mask = nullptr;  // 0 where there is no height; null: none
  std::string name;
  double scale = 1, offset = 0;  // metres = stored · scale + offset
  std::optional<double> no_data;
};

// Returns the names of all bands: their descriptions, or their numbers from 1.
std::vector<std::string> band_names(const GeoRaster& raster);

// Opens the one variable of a file that holds several rasters. Changes nothing where the file is one itself.
// Throws InputError naming them where `channel` is none of several.
void open_variable(const GdalLibrary& gdal, const std::string& channel, GdalDataset& dataset);

// Chooses the band. Throws InputError naming the bands where `channel` is none, where they are colours or
// layers to choose from, and for a band of complex numbers or of a unit that is no length.
GeoBand choose_band(const GeoRaster& raster, const std::string& channel);

// Returns the type of the stored values: "16-bit signed integers".
std::string sample_type_of(const GdalLibrary& gdal, GDALRasterBandH band);

}  // namespace hemibake
