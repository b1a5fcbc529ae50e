#include "io/geo_read.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/context.h"
#include "core/error.h"
#include "core/memory_limit.h"
#include "io/file_context.h"
#include "io/geo_band.h"
#include "io/geo_place.h"
#include "io/height_sink.h"
#include "io/input_file.h"
#include "io/netcdf_check.h"
#include "io/output_file.h"
#include "surface/surface.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;

constexpr int64_t kValuesPerBlock = int64_t{1} << 21;
// Heights over the longer side of a map whose coordinates can only be degrees.
constexpr double kSteepestLand = 2;

constexpr const char* kNetworkSources[] = {"/vsicurl", "/vsis3",    "/vsigs",   "/vsiaz",      "/vsiadls",
                                           "/vsioss",  "/vsiswift", "/vsihdfs", "/vsiwebhdfs", "/vsistdin"};
constexpr int kMostNestedSources = 8;  // VRTs of VRTs
constexpr size_t kMostVrtBytes = size_t{1} << 26;

// Returns the names between the tags of sources: <SourceFilename relativeToVRT="1">a.tif</SourceFilename>.
std::vector<std::string> vrt_sources(const fs::path& path) {
  const std::string text = read_whole_file(path);
  std::vector<std::string> names;
  for (size_t at = text.find("<Source"); at != std::string::npos; at = text.find("<Source", at + 1)) {
    const size_t begin = text.find('>', at), end = text.find("</", at);
    if (begin < end && end != std::string::npos) names.push_back(text.substr(begin + 1, end - begin - 1));
  }
  return names;
}

// Returns the file of this machine that a name of GDAL stands for: of an archive, the archive.
fs::path file_of(std::string name) {
  while (name.starts_with("/vsi")) {
    const size_t slash = name.find('/', 1);
    name = slash == std::string::npos ? "" : name.substr(slash + 1);
  }
  return name;
}

// Refuses a VRT that names anything but regular files of this machine: what else is there may block.
// depth: of VRTs that led to it.
void check_sources(const fs::path& path, int depth = 0) {
  if (lower_case_extension(path) != ".vrt") return;
  if (depth > kMostNestedSources)
    throw InputError(
        fmt::format("names itself or more than {} files within files, expected rasters", kMostNestedSources));
  std::error_code ignored;
  if (fs::file_size(path, ignored) > kMostVrtBytes)
    throw InputError(fmt::format("has over {} MiB of text, expected a VRT", kMostVrtBytes >> 20));
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    const auto names = [&](const char* text) { return line.find(text) != std::string::npos; };
    if (std::ranges::any_of(kNetworkSources, names) || (names("Source") && names("://")))
      throw InputError(
          "names a source that is no file here, expected files of this machine: fetch them first");
  }
  for (const std::string& name : vrt_sources(path)) {
    const fs::path source = file_of(name);
    for (const fs::path& place : {path.parent_path() / source, source}) {
      const fs::file_status status = fs::status(place, ignored);
      if (!fs::exists(status)) continue;
      if (!fs::is_regular_file(status) && !fs::is_directory(status))
        throw InputError(fmt::format("names a source that is no regular file ({}), expected rasters", name));
      check_sources(place, depth + 1);
    }
  }
}

GdalDataset open_dataset(const GdalLibrary& gdal, const fs::path& path) {
  check_sources(path);
  if (const std::string fault = netcdf_error(path); !fault.empty()) throw InputError(fault);
  std::error_code no_folder;
  const fs::path whole = fs::absolute(path, no_folder);
  GdalDataset dataset(gdal.GDALOpenEx((no_folder ? path : whole).string().c_str(),
                                      GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR, nullptr,
                                      nullptr, nullptr));
  if (!dataset)
    throw InputError(
        "is not terrain that can be read (damaged, cut short, or of a kind that is not read), expected a "
        "raster of heights");
  return dataset;
}

// Texels that a byte of a file can hold: Deflate makes at most 1032 equal bytes of one.
constexpr double kMostTexelsPerByte = 1032;

// Refuses a raster that its files are far too short for: memory would be set aside for what a header claims.
// GeoTIFFs may leave tiles out, and a VRT stands for other files.
void check_files_hold(const GeoRaster& raster) {
  const GdalLibrary& gdal = raster.gdal;
  const std::string driver = gdal.GDALGetDriverShortName(gdal.GDALGetDatasetDriver(raster.dataset));
  if (driver == "GTiff" || driver == "VRT") return;
  double bytes = 0;
  char** const files = gdal.GDALGetFileList(raster.dataset);
  for (char** file = files; file && *file; ++file) {
    std::error_code not_there;
    const auto size = fs::file_size(*file, not_there);
    if (!not_there) bytes += static_cast<double>(size);
  }
  gdal.CSLDestroy(files);
  if (bytes > 0 && static_cast<double>(raster.width) * raster.height > kMostTexelsPerByte * bytes)
    throw InputError(fmt::format("claims {} x {} texels and has only {:.0f} bytes, expected a whole file",
                                 raster.width, raster.height, bytes));
}

GeoRaster checked_raster(const GdalLibrary& gdal, GDALDatasetH dataset, const fs::path& path) {
  const GeoRaster raster{gdal, dataset, path, gdal.GDALGetRasterXSize(dataset),
                         gdal.GDALGetRasterYSize(dataset)};
  if (gdal.GDALGetRasterCount(dataset) < 1 || raster.width < 1 || raster.height < 1)
    throw InputError("holds no raster, expected one band of heights");
  if (static_cast<uint64_t>(raster.width) * static_cast<uint64_t>(raster.height) > kMaxTexels)
    throw InputError(
        fmt::format("claims {} x {} texels, expected at most {}", raster.width, raster.height, kMaxTexels));
  check_files_hold(raster);
  const double texels = static_cast<double>(raster.width) * raster.height;
  int block_width = 0, block_height = 0;
  gdal.GDALGetBlockSize(gdal.GDALGetRasterBand(dataset, 1), &block_width, &block_height);
  require_map_memory(
      raster.width, raster.height,
      texels * kHeightBytesPerTexel + sizeof(double) * block_width * static_cast<double>(block_height));
  return raster;
}

// Reads heights and holes by blocks of rows.
class BandReader {
 public:
  BandReader(const GeoRaster& raster, const GeoBand& band, std::optional<double> no_data)
      : raster_(raster), band_(band), no_data_(no_data) {
    int block_width = 0, block_height = 1;
    raster_.gdal.GDALGetBlockSize(band_.handle, &block_width, &block_height);
    const int most = static_cast<int>(std::max<int64_t>(1, kValuesPerBlock / raster_.width));
    // Whole blocks, but no more than memory is meant for.
    rows_ =
        std::min(raster_.height, std::max(most / block_height * block_height, std::min(block_height, most)));
    const size_t values = static_cast<size_t>(rows_) * static_cast<size_t>(raster_.width);
    stored_.resize(values);
    if (band_.mask) mask_.resize(values);
  }

  void read(HeightFile& file) {
    file.values = Grid<float>(raster_.width, raster_.height);
    Grid<uint8_t> holes(raster_.width, raster_.height);
    for (int begin = 0; begin < raster_.height; begin += rows_) {
      throw_if_cancelled();
      const int count = std::min(rows_, raster_.height - begin);
      read_rows(begin, count);
      const size_t first = static_cast<size_t>(begin) * static_cast<size_t>(raster_.width);
      const size_t values = static_cast<size_t>(count) * static_cast<size_t>(raster_.width);
      for (size_t i = 0; i < values; ++i) {
        const auto metres = static_cast<float>(stored_[i] * band_.scale + band_.offset);
        const bool is_hole =
            !std::isfinite(metres) || is_no_data(stored_[i]) || (!mask_.empty() && mask_[i] == 0);
        holes[first + i] = is_hole;
        file.values[first + i] = is_hole ? 0.0f : metres;
      }
    }
    if (std::ranges::find(holes.values, 1) != holes.values.end()) file.holes = std::move(holes);
  }

 private:
  bool is_no_data(double stored) const {
    const auto is = [&](const std::optional<double>& value) {
      return value && (stored == *value || static_cast<float>(stored) == static_cast<float>(*value));
    };
    return is(band_.no_data) || is(no_data_);
  }

  void read_rows(int begin, int count) {
    const auto take = [&](GDALRasterBandH band, void* values, GDALDataType type) {
      if (raster_.gdal.GDALRasterIO(band, GF_Read, 0, begin, raster_.width, count, values, raster_.width,
                                    count, type, 0, 0) != CE_None)
        throw InputError(fmt::format(
            "cannot be read from row {} on, it may be damaged or cut short, expected a whole file", begin));
    };
    take(band_.handle, stored_.data(), GDT_Float64);
    if (band_.mask) take(band_.mask, mask_.data(), GDT_Byte);
  }

  const GeoRaster& raster_;
  const GeoBand& band_;
  std::optional<double> no_data_;
  int rows_ = 1;
  std::vector<double> stored_;
  std::vector<uint8_t> mask_;
};

void turn_upside_down(HeightFile& file) {
  const auto turn = [](auto& grid) {
    const auto width = static_cast<std::ptrdiff_t>(grid.width);
    for (std::ptrdiff_t top = 0, bottom = grid.height - 1; top < bottom; ++top, --bottom)
      std::swap_ranges(grid.values.begin() + top * width, grid.values.begin() + (top + 1) * width,
                       grid.values.begin() + bottom * width);
  };
  turn(file.values);
  if (!file.holes.empty()) turn(file.holes);
}

// Refuses coordinates without a system that can only be degrees: as metres the land would be steeper than
// any.
void check_not_degrees(const GeoRaster& raster, const HeightFile& file) {
  if (!file.place || !file.place->crs.empty()) return;
  const auto& t = file.place->transform;
  const double width = std::abs(t[1]) * raster.width, height = std::abs(t[5]) * raster.height;
  const double end_x = t[0] + t[1] * raster.width, end_y = t[3] + t[5] * raster.height;
  if (std::max(std::abs(t[3]), std::abs(end_y)) > 90.1 || t[0] < -180.1 || end_x > 360.1) return;
  float low = INFINITY, high = -INFINITY;
  for (size_t i = 0; i < file.values.size(); ++i) {
    if (!file.holes.empty() && file.holes[i]) continue;
    low = std::min(low, file.values[i]);
    high = std::max(high, file.values[i]);
  }
  if (!(static_cast<double>(high - low) > kSteepestLand * std::max(width, height))) return;
  throw InputError(fmt::format(
      "names no coordinate system and would be {:.4g} m high on {:.3g} m, expected metres: if it is in "
      "degrees, {}",
      static_cast<double>(high - low), std::max(width, height), metres_command(raster, "EPSG:4326")));
}

std::optional<HeightFile> read_dataset(const fs::path& path, const HeightFileOptions& options) {
  const GdalLibrary& gdal = gdal_library();
  const GdalFaults faults(gdal);
  GdalDataset dataset = open_dataset(gdal, path);
  const bool is_variable = gdal.GDALGetRasterCount(dataset.get()) == 0;
  open_variable(gdal, options.channel, dataset);
  const GeoRaster raster = checked_raster(gdal, dataset.get(), path);
  const GDALDriverH driver = gdal.GDALGetDatasetDriver(dataset.get());
  const bool is_tiff = std::string(gdal.GDALGetDriverShortName(driver)) == "GTiff";

  HeightFile file;
  file.place = place_of(raster);
  if (is_tiff && !file.place) return std::nullopt;
  const GeoBand band = choose_band(raster, is_variable ? "" : options.channel);
  file.format = is_tiff ? "GeoTIFF" : gdal.GDALGetDriverLongName(driver);
  file.sample_type = sample_type_of(gdal, band.handle);
  file.channels = band_names(raster);
  file.channel = is_variable && !options.channel.empty() ? options.channel : band.name;
  file.in_metres = true;
  BandReader(raster, band, options.no_data).read(file);
  if (!file.holes.empty() && std::ranges::find(file.holes.values, 0) == file.holes.values.end())
    throw InputError("holds no height at all: every texel is NoData, expected heights");
  if (file.place) {
    file.place->no_data = band.no_data ? band.no_data : options.no_data;
    check_not_degrees(raster, file);
    if (file.place->transform[5] > 0) turn_upside_down(file);
  }
  return file;
}

}  // namespace

std::optional<HeightFile> read_geo_file(const fs::path& path, const HeightFileOptions& options) {
  if (!options.raw.empty() || options.encoding != SplitEncoding::kNone || options.part.value_or(0) != 0)
    return std::nullopt;
  if (!is_geo_file(path)) return std::nullopt;
  return with_file_context(path, [&] { return read_dataset(path, options); });
}

}  // namespace hemibake
