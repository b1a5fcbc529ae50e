// Places of rasters on the earth, as files record them, and the files that have one.
#pragma once

#include <filesystem>
#include <optional>

#include "io/height_file.h"
#include "io/provenance.h"

namespace hemibake {

// Returns whether a file is one of terrain: by its extension, a TIFF by its tags of GeoTIFF. False for what
// is no regular file, or empty.
bool is_geo_file(const std::filesystem::path& path);

// Returns whether a file is the header of a raster beside it: map.hdr of map.bil.
bool is_geo_header(const std::filesystem::path& path);

// Adds `geo_crs`, `geo_transform` and `geo_nodata`, all text, to a record.
void record_place(const GeoPlace& place, Provenance& provenance);

// Returns the place that record_place recorded, with what it recorded; none: there is none. Throws InputError
// where the text is none of record_place.
std::optional<GeoPlace> recorded_place(const Provenance& provenance);

// Returns the place of a raster without its outer ring.
// texels: width of the ring.
GeoPlace place_without_ring(GeoPlace place, int texels);

}  // namespace hemibake
