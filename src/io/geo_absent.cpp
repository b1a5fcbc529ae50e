// Stands for geo_read.cpp and geo_write.cpp in a build without GDAL.
#include <fmt/format.h>

#include "core/error.h"
#include "io/geo_place.h"
#include "io/geo_read.h"
#include "io/geo_write.h"

namespace hemibake {

std::optional<HeightFile> read_geo_file(const std::filesystem::path& path, const HeightFileOptions& options) {
  if (!options.raw.empty() || options.encoding != SplitEncoding::kNone || options.part.value_or(0) != 0)
    return std::nullopt;
  if (!is_geo_file(path)) return std::nullopt;
  throw InputError(fmt::format(
      "{0}: is terrain, which this build cannot read, expected one with GDAL (install libgdal-dev and build "
      "again), or a plain file in metres: `gdal_translate -ot Float32 -co PROFILE=BASELINE {0} out.tif`",
      path.string()));
}

void write_geo_tiff(OutputFile& file, int, int, std::span<const Plane>, const GeoTag&, const Provenance&) {
  throw InputError(
      fmt::format("{}: is a GeoTIFF, which this build cannot write, expected one with GDAL (install "
                  "libgdal-dev and build again), "
                  "or another format",
                  file.path().string()));
}

}  // namespace hemibake
