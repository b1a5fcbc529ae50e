#include "io/geo_locator.h"

#include <cmath>
#include <numbers>

namespace hemibake {
namespace {

constexpr double kDegreesPerRadian = 180 / std::numbers::pi;
constexpr double kScaleStepM = 100;  // large against rounding, small against the earth

// Returns a copy with x east and y north, whatever order its authority gives.
GdalReference east_north(const GdalLibrary& gdal, OGRSpatialReferenceH reference) {
  GdalReference copy(reference ? gdal.OSRClone(reference) : nullptr);
  if (copy) gdal.OSRSetAxisMappingStrategy(copy.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return copy;
}

GdalReference geographic_of(const GdalLibrary& gdal, OGRSpatialReferenceH reference) {
  GdalReference base(reference ? gdal.OSRCloneGeogCS(reference) : nullptr);
  return east_north(gdal, base.get());
}

double wrapped(double degrees) { return std::remainder(degrees, 360); }

}  // namespace

GeoConversion::GeoConversion(const GdalLibrary& gdal, OGRSpatialReferenceH from, OGRSpatialReferenceH to)
    : gdal_(gdal), conversion_(from && to ? gdal.OCTNewCoordinateTransformation(from, to) : nullptr) {}

std::optional<GeoPoint> GeoConversion::operator()(GeoPoint point) const {
  if (!conversion_ || !gdal_.OCTTransform(conversion_.get(), 1, &point.x, &point.y, nullptr))
    return std::nullopt;
  if (!std::isfinite(point.x) || !std::isfinite(point.y)) return std::nullopt;
  return point;
}

GeoLocator::GeoLocator(const GdalLibrary& gdal, OGRSpatialReferenceH reference,
                       const std::array<double, 6>& transform)
    : transform_(transform),
      reference_(east_north(gdal, reference)),
      geographic_(geographic_of(gdal, reference)),
      to_geographic_(gdal, reference_.get(), geographic_.get()) {
  if (!geographic_) return;
  OGRErr error = OGRERR_NONE;
  degrees_per_unit_ = gdal.OSRGetAngularUnits(geographic_.get(), nullptr) * kDegreesPerRadian;
  prime_meridian_degrees_ = gdal.OSRGetPrimeMeridian(geographic_.get(), nullptr);
  semi_major_m_ = gdal.OSRGetSemiMajor(geographic_.get(), &error);
  const double inverse_flattening = gdal.OSRGetInvFlattening(geographic_.get(), &error);
  const double flattening = inverse_flattening > 0 ? 1 / inverse_flattening : 0;
  eccentricity_squared_ = flattening * (2 - flattening);
  if (!gdal.OSRIsGeographic(reference_.get()))
    metres_per_unit_ = gdal.OSRGetLinearUnits(reference_.get(), nullptr);
}

GeoPoint GeoLocator::coordinates_at(double column, double row) const {
  const auto& t = transform_;
  return {t[0] + column * t[1] + row * t[2], t[3] + column * t[4] + row * t[5]};
}

std::optional<GeoPoint> GeoLocator::degrees_of(GeoPoint point) const {
  const std::optional<GeoPoint> converted = to_geographic_(point);
  if (!converted) return std::nullopt;
  return GeoPoint{wrapped(converted->x * degrees_per_unit_ + prime_meridian_degrees_),
                  converted->y * degrees_per_unit_};
}

std::optional<GeoPoint> GeoLocator::degrees_at(double column, double row) const {
  return degrees_of(coordinates_at(column, row));
}

// Radii of curvature of an ellipsoid: N = a/√(1 − e² sin² φ) along the parallel, M = N (1 − e²)/(1 − e² sin²
// φ) along the meridian (Snyder 1987, equations 4-18 and 4-20).
GeoPoint GeoLocator::metres_between(GeoPoint from, GeoPoint to) const {
  const double latitude = from.y / kDegreesPerRadian;
  const double w = 1 - eccentricity_squared_ * std::pow(std::sin(latitude), 2);
  const double across = semi_major_m_ / std::sqrt(w);
  const double along = across * (1 - eccentricity_squared_) / w;
  return {wrapped(to.x - from.x) / kDegreesPerRadian * across * std::cos(latitude),
          (to.y - from.y) / kDegreesPerRadian * along};
}

std::optional<GroundScale> GeoLocator::scale_at(double column, double row) const {
  const GeoPoint here = coordinates_at(column, row);
  const double step = kScaleStepM / metres_per_unit_;
  const auto origin = degrees_of(here);
  const auto east = degrees_of({here.x + step, here.y});
  const auto north = degrees_of({here.x, here.y + step});
  if (!origin || !east || !north || semi_major_m_ <= 0) return std::nullopt;
  const GeoPoint x = metres_between(*origin, *east), y = metres_between(*origin, *north);
  return GroundScale{std::hypot(x.x, x.y) / kScaleStepM, std::hypot(y.x, y.y) / kScaleStepM};
}

}  // namespace hemibake
