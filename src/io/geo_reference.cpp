#include "io/geo_reference.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/error.h"
#include "io/geo_locator.h"

namespace hemibake {
namespace {

// UTM stays within .1 % over its zone.
constexpr double kExactScale = 0.005;
// Web Mercator is spherical on an ellipsoid: .7 % apart at the equator.
constexpr double kMostStretch = 0.01;
// Distortion over the map above which one size for all texels would bend slopes.
constexpr double kMostScaleSpread = 0.1;
// Shear over the whole raster, in texels, that is rounding.
constexpr double kMostShear = 0.01;

std::string wkt_of(const GdalLibrary& gdal, OGRSpatialReferenceH reference) {
  char* text = nullptr;
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  std::string wkt;
  if (gdal.OSRExportToWktEx(reference, &text, options) == OGRERR_NONE && text) wkt = text;
  gdal.VSIFree(text);
  return wkt;
}

void check_north_up(const GeoRaster& raster, const GeoPlace& place) {
  const auto& t = place.transform;
  for (const double number : t)
    if (!std::isfinite(number)) throw InputError("its coordinates are not finite, expected numbers");
  const bool sheared = std::abs(t[2]) * raster.height > kMostShear * std::abs(t[1]) ||
                       std::abs(t[4]) * raster.width > kMostShear * std::abs(t[5]);
  if (!sheared && t[1] > 0 && t[5] != 0) return;
  if (!sheared && (t[1] == 0 || t[5] == 0)) throw InputError("its texels have no size, expected metres");
  throw InputError(fmt::format("its rows are {}, expected rows from west to east: {}",
                               sheared ? "turned against the coordinates" : "mirrored",
                               metres_command(raster)));
}

// Puts the true size of a unit of the coordinates into the place.
void measure_units(const GeoRaster& raster, const GeoLocator& locator, GeoPlace& place) {
  const std::optional<GroundScale> middle = locator.scale_at(raster.width / 2.0, raster.height / 2.0);
  if (!middle) return;
  const double ratio = middle->x / middle->y;
  bool uneven = std::abs(ratio - 1) > kMostStretch;
  for (const double x : {0.0, static_cast<double>(raster.width)})
    for (const double y : {0.0, static_cast<double>(raster.height)})
      if (const std::optional<GroundScale> corner = locator.scale_at(x, y))
        uneven = uneven || std::abs(corner->x / middle->x - 1) > kMostScaleSpread ||
                 std::abs(corner->y / middle->y - 1) > kMostScaleSpread;
  if (uneven)
    throw InputError(fmt::format(
        "its projection stretches texels (at the middle {:.3g} m for a metre in x, {:.3g} in y), expected "
        "true metres: {}",
        middle->x, middle->y, metres_command(raster)));
  const double scale = std::sqrt(middle->x * middle->y);
  if (std::abs(scale - 1) > kExactScale) place.metres_per_unit *= scale;
}

}  // namespace

std::optional<GeoPlace> place_of(const GeoRaster& raster) {
  const GdalLibrary& gdal = raster.gdal;
  GeoPlace place;
  if (gdal.GDALGetGeoTransform(raster.dataset, place.transform.data()) != CE_None) return std::nullopt;
  const OGRSpatialReferenceH reference = gdal.GDALGetSpatialRef(raster.dataset);
  if (reference) {
    place.crs = wkt_of(gdal, reference);
    if (gdal.OSRIsGeographic(reference))
      throw InputError(fmt::format("is in degrees, expected metres: {}", metres_command(raster)));
    if (gdal.OSRIsGeocentric(reference))
      throw InputError(
          fmt::format("is in geocentric coordinates, expected metres: {}", metres_command(raster)));
    place.metres_per_unit = gdal.OSRGetLinearUnits(reference, nullptr);
  }
  check_north_up(raster, place);
  if (reference && gdal.OSRIsProjected(reference))
    measure_units(raster, GeoLocator(gdal, reference, place.transform), place);
  return place;
}

}  // namespace hemibake
