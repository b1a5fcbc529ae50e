#include "io/geo_band.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "core/error.h"

namespace hemibake {
namespace {

constexpr size_t kMostNames = 12;  // of variables in a message
constexpr double kFootM = 0.3048, kSurveyFootM = 1200.0 / 3937;

struct Unit {
  const char* name;
  double metres;
};
constexpr std::array kUnits = {Unit{"", 1},
                               Unit{"m", 1},
                               Unit{"meter", 1},
                               Unit{"meters", 1},
                               Unit{"metre", 1},
                               Unit{"metres", 1},
                               Unit{"unknown", 1},
                               Unit{"none", 1},
                               Unit{"unspecified", 1},
                               Unit{"undefined", 1},
                               Unit{"1", 1},
                               Unit{"km", 1000},
                               Unit{"kilometer", 1000},
                               Unit{"kilometers", 1000},
                               Unit{"kilometre", 1000},
                               Unit{"dm", 0.1},
                               Unit{"decimeter", 0.1},
                               Unit{"decimetre", 0.1},
                               Unit{"cm", 0.01},
                               Unit{"centimeter", 0.01},
                               Unit{"centimeters", 0.01},
                               Unit{"centimetre", 0.01},
                               Unit{"mm", 0.001},
                               Unit{"ft", kFootM},
                               Unit{"foot", kFootM},
                               Unit{"feet", kFootM},
                               Unit{"international foot", kFootM},
                               Unit{"us-ft", kSurveyFootM},
                               Unit{"ftus", kSurveyFootM},
                               Unit{"us survey foot", kSurveyFootM},
                               Unit{"us survey feet", kSurveyFootM},
                               Unit{"foot_us", kSurveyFootM}};

std::string lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// Returns the metres of a unit of the heights: the band's own, else that of the vertical axis.
double metres_per_value(const GeoRaster& raster, GDALRasterBandH band) {
  const GdalLibrary& gdal = raster.gdal;
  const std::string name = gdal.GDALGetRasterUnitType(band);
  const auto unit =
      std::ranges::find(kUnits, lower_case(name), [](const Unit& u) { return std::string(u.name); });
  if (unit == kUnits.end())
    throw InputError(
        fmt::format("its values are in '{}', expected heights in metres or feet: "
                    "`gdal_edit.py -units m` corrects a wrong unit",
                    name));
  const OGRSpatialReferenceH reference = gdal.GDALGetSpatialRef(raster.dataset);
  if (!name.empty() || !reference) return unit->metres;
  const double vertical = gdal.OSRGetTargetLinearUnits(reference, "VERT_CS", nullptr);
  return vertical > 0 ? vertical : 1;
}

std::string driver_of(const GdalLibrary& gdal, GDALDatasetH dataset) {
  return gdal.GDALGetDriverShortName(gdal.GDALGetDatasetDriver(dataset));
}

std::vector<std::string> subdatasets_of(const GdalLibrary& gdal, GDALDatasetH dataset) {
  std::vector<std::string> names;
  char** const entries = gdal.GDALGetMetadata(dataset, "SUBDATASETS");
  for (char** entry = entries; entry && *entry; ++entry) {
    const std::string text = *entry;
    const size_t equals = text.find('=');
    if (equals != std::string::npos && text.substr(0, equals).ends_with("_NAME"))
      names.push_back(text.substr(equals + 1));
  }
  return names;
}

std::string variable_of(const std::string& subdataset) {
  const size_t colon = subdataset.rfind(':');
  return colon == std::string::npos ? subdataset : subdataset.substr(colon + 1);
}

std::string joined(std::vector<std::string> names) {
  const bool cut = names.size() > kMostNames;
  if (cut) names.resize(kMostNames);
  return fmt::format("{}{}", fmt::join(names, ", "), cut ? ", …" : "");
}

std::string interpretation(const GeoRaster& raster, int number) {
  const GdalLibrary& gdal = raster.gdal;
  return gdal.GDALGetColorInterpretationName(
      gdal.GDALGetRasterColorInterpretation(gdal.GDALGetRasterBand(raster.dataset, number)));
}

// The first band, unless the file asks for a choice.
int first_band(const GeoRaster& raster, const std::vector<std::string>& names) {
  const std::string kind = interpretation(raster, 1);
  if (kind == "Red" && names.size() > 1)
    throw SettingError(fmt::format(
        "is a picture of {} bands of colour, expected heights: {{channel}} N takes a band", names.size()));
  if (kind == "Palette")
    throw SettingError(
        "holds numbers of colours in a table, expected heights: {channel} 1 takes them all the same");
  if (names.size() > 1 && driver_of(raster.gdal, raster.dataset) == "netCDF")
    throw SettingError(
        fmt::format("holds {} layers, expected one: cut it out with `gdal_translate -b 1 '{}' out.tif`",
                    names.size(), raster.gdal.GDALGetDescription(raster.dataset)));
  return 1;
}

int find_band(const GeoRaster& raster, const std::string& channel) {
  const std::vector<std::string> names = band_names(raster);
  if (channel.empty()) return first_band(raster, names);
  for (size_t i = 0; i < names.size(); ++i)
    if (channel == names[i] || channel == std::to_string(i + 1)) return static_cast<int>(i + 1);
  throw SettingError(
      fmt::format("{{channel}} {}: has no such band, expected one of {}", channel, joined(names)));
}

// Returns GDAL's mask, or an alpha band of a type that GDAL does not take for one; null: none.
GDALRasterBandH mask_of(const GeoRaster& raster, GDALRasterBandH band) {
  const GdalLibrary& gdal = raster.gdal;
  if (gdal.GDALGetMaskFlags(band) != GMF_ALL_VALID) return gdal.GDALGetMaskBand(band);
  for (int i = 1; i <= gdal.GDALGetRasterCount(raster.dataset); ++i) {
    const GDALRasterBandH other = gdal.GDALGetRasterBand(raster.dataset, i);
    if (other != band && gdal.GDALGetRasterColorInterpretation(other) == GCI_AlphaBand) return other;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> band_names(const GeoRaster& raster) {
  std::vector<std::string> names;
  const int count = raster.gdal.GDALGetRasterCount(raster.dataset);
  for (int i = 1; i <= count; ++i) {
    const std::string name = raster.gdal.GDALGetDescription(raster.gdal.GDALGetRasterBand(raster.dataset, i));
    names.push_back(name.empty() ? std::to_string(i) : name);
  }
  return names;
}

void open_variable(const GdalLibrary& gdal, const std::string& channel, GdalDataset& dataset) {
  const std::vector<std::string> subdatasets = subdatasets_of(gdal, dataset.get());
  if (gdal.GDALGetRasterCount(dataset.get()) > 0 || subdatasets.empty()) return;
  std::vector<std::string> names;
  std::ranges::transform(subdatasets, std::back_inserter(names), variable_of);
  const auto found = channel.empty() && names.size() == 1 ? names.begin() : std::ranges::find(names, channel);
  if (found == names.end())
    throw SettingError(fmt::format("holds {} variables, expected the name of one with {{channel}}: {}",
                                   names.size(), joined(names)));
  const std::string& chosen = subdatasets[static_cast<size_t>(found - names.begin())];
  dataset.reset(
      gdal.GDALOpenEx(chosen.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, nullptr, nullptr));
  if (!dataset) throw InputError(fmt::format("variable {} cannot be read, expected a raster", *found));
}

GeoBand choose_band(const GeoRaster& raster, const std::string& channel) {
  const GdalLibrary& gdal = raster.gdal;
  GeoBand band;
  const int number = find_band(raster, channel);
  band.handle = gdal.GDALGetRasterBand(raster.dataset, number);
  band.mask = mask_of(raster, band.handle);
  band.name = band_names(raster)[static_cast<size_t>(number - 1)];
  if (gdal.GDALDataTypeIsComplex(gdal.GDALGetRasterDataType(band.handle)))
    throw InputError("holds complex numbers, expected heights");
  const double metres = metres_per_value(raster, band.handle);
  band.scale = gdal.GDALGetRasterScale(band.handle, nullptr) * metres;
  band.offset = gdal.GDALGetRasterOffset(band.handle, nullptr) * metres;
  int has_no_data = 0;
  const double no_data = gdal.GDALGetRasterNoDataValue(band.handle, &has_no_data);
  if (has_no_data) band.no_data = no_data;
  return band;
}

std::string sample_type_of(const GdalLibrary& gdal, GDALRasterBandH band) {
  const GDALDataType type = gdal.GDALGetRasterDataType(band);
  return fmt::format("{}-bit {}", gdal.GDALGetDataTypeSizeBits(type),
                     gdal.GDALDataTypeIsFloating(type) ? "floats"
                     : gdal.GDALDataTypeIsSigned(type) ? "signed integers"
                                                       : "integers");
}

}  // namespace hemibake
