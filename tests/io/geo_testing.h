// Terrain for tests, made by hand and by GDAL's own programs.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "core/grid.h"
#include "io/io_testing.h"
#include "support/run_command.h"

namespace hemibake {

constexpr int kGeoWidth = 40, kGeoHeight = 30;

// Heights with three decimals, which floats and text hold alike.
inline double geo_height(int x, int y) {
  return std::round(1000 * (500 + 30 * std::sin(x / 5.0) + 20 * std::cos(y / 4.0) + x)) / 1000;
}

// A folder with a.asc, 10 m texels in zone 32 of UTM as a.prj says, and without GDAL a reason to skip.
class GeoTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!HEMIBAKE_WITH_GDAL) GTEST_SKIP() << "this build has no GDAL";
    if (run_command("gdalinfo --version", folder_.path()).exit_code != 0) GTEST_SKIP() << "no gdal-bin";
    write_bytes(folder_ / "bare.asc", asc_text(""));
    gdal("gdal_translate -q -ot Float32 -a_srs EPSG:32632 bare.asc a.tif");
  }

  // first_value: instead of the first height; empty: that.
  static std::string asc_text(const std::string& first_value, double corner_x = 400000,
                              double corner_y = 5200000, double cell = 10) {
    std::string text =
        fmt::format("ncols {}\nnrows {}\nxllcorner {}\nyllcorner {}\ncellsize {}\nNODATA_value -9999\n",
                    kGeoWidth, kGeoHeight, corner_x, corner_y, cell);
    for (int y = 0; y < kGeoHeight; ++y) {
      for (int x = 0; x < kGeoWidth; ++x)
        text +=
            x + y == 0 && !first_value.empty() ? first_value + " " : fmt::format("{:.3f} ", geo_height(x, y));
      text += "\n";
    }
    return text;
  }

  // Runs a line in the folder and expects success.
  std::string gdal(const std::string& line) const {
    const CommandOutcome outcome =
        run_command("cd '" + folder_.path().string() + "' && " + line, folder_.path());
    EXPECT_EQ(outcome.exit_code, 0) << line << "\n" << outcome.err;
    return outcome.out;
  }

  // A virtual raster over a.tif.
  // inside: XML of the raster; of_band: of its band.
  void write_vrt(const std::string& name, const std::string& inside, const std::string& of_band,
                 const std::string& source = "a.tif") const {
    write_bytes(
        folder_ / name,
        fmt::format("<VRTDataset rasterXSize=\"{}\" rasterYSize=\"{}\">{}<VRTRasterBand dataType=\"Float32\" "
                    "band=\"1\">{}<SimpleSource><SourceFilename relativeToVRT=\"{}\">{}</SourceFilename>"
                    "<SourceBand>1</SourceBand></SimpleSource></VRTRasterBand></VRTDataset>",
                    kGeoWidth, kGeoHeight, inside, of_band, source.starts_with('/') ? 0 : 1, source));
  }

  TemporaryFolder folder_;
};

// Big-endian 32-bit words, as classic netCDF has them.
class NetcdfWriter {
 public:
  void word(uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 255);
  }
  void text(const std::string& value) {
    word(static_cast<uint32_t>(value.size()));
    bytes += value;
    while (bytes.size() % 4 != 0) bytes += '\0';
  }
  std::string bytes;
};

// A file of CDF-1 with variables of width × height floats over y and x: variable k holds k everywhere.
inline std::string classic_netcdf(int width, int height, const std::vector<std::string>& names) {
  constexpr uint32_t kDimensions = 10, kVariables = 11, kFloat = 5;
  const auto size = static_cast<uint32_t>(4 * width * height);
  const auto header = [&](uint32_t begin) {
    NetcdfWriter out;
    out.bytes = std::string("CDF\x01", 4);
    for (const uint32_t word : {0u, kDimensions, 2u}) out.word(word);
    out.text("y");
    out.word(static_cast<uint32_t>(height));
    out.text("x");
    out.word(static_cast<uint32_t>(width));
    for (const uint32_t word : {0u, 0u, kVariables, static_cast<uint32_t>(names.size())}) out.word(word);
    for (size_t k = 0; k < names.size(); ++k) {
      out.text(names[k]);
      for (const uint32_t word : {2u, 0u, 1u, 0u, 0u, kFloat, size, begin + static_cast<uint32_t>(k) * size})
        out.word(word);
    }
    return out;
  };
  NetcdfWriter out = header(static_cast<uint32_t>(header(0).bytes.size()));
  for (size_t k = 0; k < names.size(); ++k)
    for (int i = 0; i < width * height; ++i) out.word(std::bit_cast<uint32_t>(static_cast<float>(k)));
  return out.bytes;
}

}  // namespace hemibake
