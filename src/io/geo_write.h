// Writes GeoTIFF through GDAL: images that keep their place on the earth.
#pragma once

#include <span>

#include "io/height_file.h"
#include "io/image_io.h"
#include "io/output_file.h"

namespace hemibake {

// What a GeoTIFF says beside its values.
struct GeoTag {
  const GeoPlace& place;       // a transform of zeros: none
  const Grid<uint8_t>& holes;  // 1: NoData in every band; empty: none
};

// Writes planes of width × height, finite, as a tiled GeoTIFF of 32-bit floats, compressed, into `file`,
// which stays to be committed. Coordinates, NoData and the order of rows are the place's; NoData is -9999
// where holes need one and the place has none. A value that equals NoData by chance moves by one rounding.
// The same bytes at every run. Throws InputError where GDAL cannot be loaded or the file cannot be written.
// provenance: becomes the ImageDescription, as JSON.
void write_geo_tiff(OutputFile& file, int width, int height, std::span<const Plane> planes, const GeoTag& tag,
                    const Provenance& provenance);

}  // namespace hemibake
