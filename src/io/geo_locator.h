// Longitude and latitude of texels, and true lengths on the ground.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "io/gdal_library.h"

namespace hemibake {

struct GeoPoint {
  double x = 0, y = 0;
};

// True metres for a metre of the coordinates.
struct GroundScale {
  double x = 1, y = 1;
};

// Converts coordinates from one reference to another.
class GeoConversion {
 public:
  // Either may be null; then nothing converts.
  GeoConversion(const GdalLibrary& gdal, OGRSpatialReferenceH from, OGRSpatialReferenceH to);
  std::optional<GeoPoint> operator()(GeoPoint point) const;

 private:
  struct Closer {
    void operator()(OGRCoordinateTransformationH conversion) const {
      gdal_library().OCTDestroyCoordinateTransformation(conversion);
    }
  };
  const GdalLibrary& gdal_;
  std::unique_ptr<std::remove_pointer_t<OGRCoordinateTransformationH>, Closer> conversion_;
};

class GeoLocator {
 public:
  // reference: of the raster. transform: as GDAL's.
  GeoLocator(const GdalLibrary& gdal, OGRSpatialReferenceH reference, const std::array<double, 6>& transform);

  // column, row: of texel corners, from 0. Each returns nothing where no such place is.
  GeoPoint coordinates_at(double column, double row) const;
  std::optional<GeoPoint> degrees_at(double column, double row) const;  // x: longitude, −180..180
  std::optional<GroundScale> scale_at(double column, double row) const;
  // Metres between two close points in degrees, east and north.
  GeoPoint metres_between(GeoPoint from, GeoPoint to) const;

  double radius_m() const { return semi_major_m_; }

 private:
  std::optional<GeoPoint> degrees_of(GeoPoint point) const;

  std::array<double, 6> transform_;
  GdalReference reference_, geographic_;
  GeoConversion to_geographic_;
  double degrees_per_unit_ = 1, prime_meridian_degrees_ = 0;
  double semi_major_m_ = 0, eccentricity_squared_ = 0, metres_per_unit_ = 1;
};

}  // namespace hemibake
