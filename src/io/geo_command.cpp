#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/geo_locator.h"
#include "io/geo_reference.h"

namespace hemibake {
namespace {

constexpr double kEarthRadiusM = 6378137;
constexpr double kWidestDegrees = 12;  // two zones of UTM
constexpr double kPartDegrees = 1;     // of the part to cut out of a wider raster
constexpr int kEdgeSamples = 64;

// Quotes a word for /bin/sh where it needs it.
std::string quoted(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) ||
           std::string_view("/._-+:,=@").find(c) != std::string_view::npos;
  };
  if (!word.empty() && word[0] != '-' && std::ranges::all_of(word, is_plain)) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

// The conformal projection of metres about a place: UTM, or stereographic near the poles and on other bodies.
std::string projection_about(GeoPoint degrees, double radius_m) {
  const bool on_earth = std::abs(radius_m / kEarthRadiusM - 1) < 0.01;
  if (!on_earth || degrees.y >= 84 || degrees.y <= -80)
    return fmt::format("+proj=stere +lat_0={:.4f} +lon_0={:.4f} {} +units=m", degrees.y, degrees.x,
                       on_earth ? "+datum=WGS84" : fmt::format("+R={:.0f}", radius_m));
  const int zone = std::clamp(static_cast<int>(std::floor((degrees.x + 180) / 6)) + 1, 1, 60);
  return fmt::format("EPSG:{}", (degrees.y < 0 ? 32700 : 32600) + zone);
}

double two_digits(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 1);
  return std::round(value / unit) * unit;
}

// Geometric mean of the sides of the middle texel.
double texel_m(const GeoRaster& raster, const GeoLocator& locator) {
  const double column = raster.width / 2.0, row = raster.height / 2.0;
  const auto here = locator.degrees_at(column, row), right = locator.degrees_at(column + 1, row),
             below = locator.degrees_at(column, row + 1);
  if (!here || !right || !below) return 0;
  const GeoPoint x = locator.metres_between(*here, *right), y = locator.metres_between(*here, *below);
  return std::sqrt(std::hypot(x.x, x.y) * std::hypot(y.x, y.y));
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// The four edges of a raster in other coordinates.
struct Edges {
  Range left, right, top, bottom;  // x of the first two, y of the others
  bool whole = true;
};

Edges edges_in(const GeoRaster& raster, const GeoLocator& locator, const GeoConversion& convert) {
  Edges edges;
  const auto add = [&](double column, double row, Range& range, bool is_x) {
    const auto point = convert(locator.coordinates_at(column, row));
    edges.whole = edges.whole && point;
    if (point) range.add(is_x ? point->x : point->y);
  };
  for (int i = 0; i <= kEdgeSamples; ++i) {
    const double column = raster.width * i / static_cast<double>(kEdgeSamples);
    const double row = raster.height * i / static_cast<double>(kEdgeSamples);
    add(0, row, edges.left, true);
    add(raster.width, row, edges.right, true);
    add(column, 0, edges.top, false);
    add(column, raster.height, edges.bottom, false);
  }
  if (edges.left.low > edges.right.low) std::swap(edges.left, edges.right);
  if (edges.bottom.low > edges.top.low) std::swap(edges.bottom, edges.top);
  return edges;
}

// Returns " -te …" of the largest upright rectangle inside a raster, on multiples of the texel; empty: none.
std::string inner_rectangle(const GeoRaster& raster, const GeoLocator& locator, const GeoConversion& convert,
                            double texel) {
  const Edges edges = edges_in(raster, locator, convert);
  const double left = std::ceil(edges.left.high / texel) * texel,
               right = std::floor(edges.right.low / texel) * texel;
  const double bottom = std::ceil(edges.bottom.high / texel) * texel,
               top = std::floor(edges.top.low / texel) * texel;
  if (!edges.whole || !(right - left >= texel) || !(top - bottom >= texel)) return "";
  return fmt::format(" -te {:.10g} {:.10g} {:.10g} {:.10g}", left, bottom, right, top);
}

// Returns " -dstnodata -9999" for a raster that has no value of its own for texels beyond its border.
std::string no_data_option(const GeoRaster& raster) {
  int has = 0;
  raster.gdal.GDALGetRasterNoDataValue(raster.gdal.GDALGetRasterBand(raster.dataset, 1), &has);
  return has ? "" : " -dstnodata -9999";
}

std::string cut_command(const GeoRaster& raster, double degrees_wide) {
  const double part = kPartDegrees / degrees_wide;
  const int width = std::clamp(static_cast<int>(raster.width * part), 1, raster.width);
  const int height = std::clamp(width, 1, raster.height);
  return fmt::format("cut out a part of it first, as `gdal_translate -srcwin {} {} {} {} {} part.tif`",
                     (raster.width - width) / 2, (raster.height - height) / 2, width, height,
                     quoted(raster.path.string()));
}

}  // namespace

std::string metres_command(const GeoRaster& raster, const std::string& assumed_crs) {
  const GdalLibrary& gdal = raster.gdal;
  const std::string plain = fmt::format("`gdalwarp -r bilinear -ot Float32{} {} out.tif`",
                                        no_data_option(raster), quoted(raster.path.string()));
  std::array<double, 6> transform{};
  GdalReference assumed(assumed_crs.empty() ? nullptr : gdal.OSRNewSpatialReference(nullptr));
  if (assumed) gdal.OSRSetFromUserInput(assumed.get(), assumed_crs.c_str());
  const OGRSpatialReferenceH reference = assumed ? assumed.get() : gdal.GDALGetSpatialRef(raster.dataset);
  if (!reference || gdal.GDALGetGeoTransform(raster.dataset, transform.data()) != CE_None) return plain;
  const GeoLocator locator(gdal, reference, transform);
  const auto middle = locator.degrees_at(raster.width / 2.0, raster.height / 2.0);
  const auto next = locator.degrees_at(raster.width / 2.0 + 1, raster.height / 2.0);
  const double texel = texel_m(raster, locator);
  if (!middle || !next || !(texel > 0) || !std::isfinite(texel)) return plain;
  const double degrees_wide =
      std::hypot(std::remainder(next->x - middle->x, 360), next->y - middle->y) * raster.width;
  if (degrees_wide > kWidestDegrees) return cut_command(raster, degrees_wide);
  const std::string target = projection_about(*middle, locator.radius_m());
  const double rounded = two_digits(texel);
  GdalReference wanted(gdal.OSRNewSpatialReference(nullptr));
  gdal.OSRSetFromUserInput(wanted.get(), target.c_str());
  gdal.OSRSetAxisMappingStrategy(wanted.get(), OAMS_TRADITIONAL_GIS_ORDER);
  GdalReference source(gdal.OSRClone(reference));
  gdal.OSRSetAxisMappingStrategy(source.get(), OAMS_TRADITIONAL_GIS_ORDER);
  const GeoConversion convert(gdal, source.get(), wanted.get());
  const std::string from = assumed ? " -s_srs " + assumed_crs : "";
  return fmt::format("`gdalwarp{} -t_srs {} -tr {:.10g} {:.10g}{} -r bilinear -ot Float32{} {} out.tif`",
                     from, quoted(target), rounded, rounded,
                     inner_rectangle(raster, locator, convert, rounded), no_data_option(raster),
                     quoted(raster.path.string()));
}

}  // namespace hemibake
