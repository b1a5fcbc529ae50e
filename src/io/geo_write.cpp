#include "io/geo_write.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/context.h"
#include "core/error.h"
#include "io/file_context.h"
#include "io/gdal_library.h"

namespace hemibake {
namespace {

constexpr int kRowsPerBlock = 256;  // a row of tiles
constexpr double kDefaultNoData = -9999;
constexpr double kLargestFloat = std::numeric_limits<float>::max();

// The NoData of floats: the place's, where floats can hold it.
std::optional<double> no_data_of(const GeoTag& tag) {
  if (tag.place.no_data && !(std::abs(*tag.place.no_data) > kLargestFloat)) return tag.place.no_data;
  if (tag.place.no_data || !tag.holes.empty()) return kDefaultNoData;
  return std::nullopt;
}

// A file in memory, which GDAL writes and an OutputFile takes: GDAL would not say which error a disk had.
class MemoryFile {
 public:
  MemoryFile(const GdalLibrary& gdal, const void* unique)
      : gdal_(gdal), name_(fmt::format("/vsimem/hemibake-{}.tif", fmt::ptr(unique))) {}
  ~MemoryFile() { gdal_.VSIUnlink(name_.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const char* name() const { return name_.c_str(); }
  std::string_view bytes() const {
    vsi_l_offset size = 0;
    const GByte* data = gdal_.VSIGetMemFileBuffer(name(), &size, FALSE);
    return {reinterpret_cast<const char*>(data), data ? size : 0};
  }

 private:
  const GdalLibrary& gdal_;
  std::string name_;
};

class GeoWriter {
 public:
  GeoWriter(const GdalLibrary& gdal, int width, int height, std::span<const Plane> planes, const GeoTag& tag)
      : gdal_(gdal), width_(width), height_(height), planes_(planes), tag_(tag), no_data_(no_data_of(tag)) {}

  void write(const char* path, const Provenance& provenance) {
    const char* const options[] = {"TILED=YES",         "COMPRESS=DEFLATE",    "PREDICTOR=3",
                                   "INTERLEAVE=PIXEL",  "BIGTIFF=IF_SAFER",    "PHOTOMETRIC=MINISBLACK",
                                   "ALPHA=UNSPECIFIED", "PROFILE=GDALGeoTIFF", nullptr};
    const GdalDataset dataset(gdal_.GDALCreate(gdal_.GDALGetDriverByName("GTiff"), path, width_, height_,
                                               static_cast<int>(planes_.size()), GDT_Float32,
                                               const_cast<char**>(options)));
    if (!dataset) return;  // which is a fault
    describe(dataset.get(), provenance);
    for (int begin = 0; begin < height_; begin += kRowsPerBlock) {
      throw_if_cancelled();
      if (!write_rows(dataset.get(), begin, std::min(kRowsPerBlock, height_ - begin))) return;
    }
  }

 private:
  void describe(GDALDatasetH dataset, const Provenance& provenance) const {
    std::array<double, 6> transform = tag_.place.transform;
    if (transform != std::array<double, 6>{}) gdal_.GDALSetGeoTransform(dataset, transform.data());
    if (!tag_.place.crs.empty()) {
      const GdalReference reference(gdal_.OSRNewSpatialReference(tag_.place.crs.c_str()));
      if (!reference)
        throw InputError("its place on the earth has a coordinate system that is not known, expected WKT");
      gdal_.OSRSetAxisMappingStrategy(reference.get(), OAMS_TRADITIONAL_GIS_ORDER);
      gdal_.GDALSetSpatialRef(dataset, reference.get());
    }
    gdal_.GDALSetMetadataItem(dataset, "TIFFTAG_IMAGEDESCRIPTION", provenance.dump().c_str(), nullptr);
    for (size_t k = 0; k < planes_.size(); ++k) {
      const GDALRasterBandH band = gdal_.GDALGetRasterBand(dataset, static_cast<int>(k) + 1);
      gdal_.GDALSetDescription(band, planes_[k].channel.c_str());
      if (no_data_) gdal_.GDALSetRasterNoDataValue(band, *no_data_);
    }
  }

  float stored(float value, size_t texel) const {
    if (!no_data_) return value;
    const auto no_data = static_cast<float>(*no_data_);
    if (!tag_.holes.empty() && tag_.holes[texel]) return no_data;
    return value == no_data ? std::nextafter(value, 0.5f) : value;
  }

  // Returns whether rows could be written.
  // begin: first row of the file, which goes south to north where the place's rows do.
  bool write_rows(GDALDatasetH dataset, int begin, int count) {
    const auto width = static_cast<size_t>(width_);
    const bool south_up = tag_.place.transform[5] > 0;
    block_.resize(static_cast<size_t>(count) * width * planes_.size());
    float* out = block_.data();
    for (int row = begin; row < begin + count; ++row) {
      const size_t first = static_cast<size_t>(south_up ? height_ - 1 - row : row) * width;
      for (size_t texel = first; texel < first + width; ++texel)
        for (const Plane& plane : planes_) *out++ = stored(plane.first[texel * plane.stride], texel);
    }
    const auto bands = static_cast<int>(planes_.size());
    constexpr int kBytes = sizeof(float);
    return gdal_.GDALDatasetRasterIO(dataset, GF_Write, 0, begin, width_, count, block_.data(), width_, count,
                                     GDT_Float32, bands, nullptr, kBytes * bands, kBytes * bands * width_,
                                     kBytes) == CE_None;
  }

  const GdalLibrary& gdal_;
  int width_, height_;
  std::span<const Plane> planes_;
  const GeoTag& tag_;
  std::optional<double> no_data_;
  std::vector<float> block_;
};

}  // namespace

void write_geo_tiff(OutputFile& file, int width, int height, std::span<const Plane> planes, const GeoTag& tag,
                    const Provenance& provenance) {
  const GdalLibrary& gdal = gdal_library();
  const GdalFaults faults(gdal);
  const MemoryFile memory(gdal, &file);
  with_file_context(file.path(), [&] {
    GeoWriter(gdal, width, height, planes, tag).write(memory.name(), provenance);
    if (faults.found())
      throw InputError(
          fmt::format("could not be made a GeoTIFF of {} x {} texels in {} bands, expected what GeoTIFF and "
                      "memory hold: write an .exr",
                      width, height, planes.size()));
  });
  file.write(memory.bytes());
}

}  // namespace hemibake
