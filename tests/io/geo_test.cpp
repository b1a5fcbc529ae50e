// Terrain as GDAL reads and writes it: values, units, places, holes, and what is refused.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include <bit>
#include <limits>
#include <numbers>

#include "io/geo_place.h"
#include "io/geo_read.h"
#include "io/geo_testing.h"
#include "io/geo_write.h"
#include "io/height_file.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

class Geo : public GeoTest {
 protected:
  HeightFile read(const std::string& name, const HeightFileOptions& options = {}) const {
    return read_height_file(folder_ / name, options);
  }
  std::string refusal(const std::string& name, const HeightFileOptions& options = {}) const {
    return error_of<InputError>([&] { read(name, options); });
  }
};

// Every value in metres is the stored one times scale plus offset; south_up: rows of the source go north.
void expect_heights(const HeightFile& file, double scale = 1, double offset = 0, bool south_up = false) {
  ASSERT_EQ(file.values.width, kGeoWidth);
  ASSERT_EQ(file.values.height, kGeoHeight);
  EXPECT_TRUE(file.in_metres);
  for (int y = 0; y < kGeoHeight; ++y)
    for (int x = 0; x < kGeoWidth; ++x) {
      const double stored = static_cast<float>(geo_height(x, south_up ? kGeoHeight - 1 - y : y));
      ASSERT_EQ(file.values(x, y), static_cast<float>(stored * scale + offset)) << x << "," << y;
    }
}

TEST_F(Geo, EveryFormatHoldsTheSameHeightsAndPlace) {
  const std::pair<const char*, const char*> formats[] = {{"b.tif", "-co TILED=YES -co COMPRESS=LZW"},
                                                         {"big.tif", "-co BIGTIFF=YES -co ENDIANNESS=BIG"},
                                                         {"cog.tif", "-of COG"},
                                                         {"b.bil", "-of EHdr"},
                                                         {"b.img", "-of HFA"},
                                                         {"b.vrt", "-of VRT"},
                                                         {"b.nc", "-of netCDF"},
                                                         {"b4.nc", "-of netCDF -co FORMAT=NC4"},
                                                         {"b2.nc", "-of netCDF -co FORMAT=NC2"},
                                                         {"b.asc", "-of AAIGrid -co DECIMAL_PRECISION=3"},
                                                         {"b.sdat", "-of SAGA"},
                                                         {"b.grd", "-of GS7BG"},
                                                         {"b.rst", "-of RST"}};
  for (const auto& [name, options] : formats) {
    SCOPED_TRACE(name);
    gdal(fmt::format("gdal_translate -q {} a.tif {}", options, name));
    const HeightFile file = read(name);
    expect_heights(file);
    ASSERT_TRUE(file.place);
    EXPECT_THAT(file.place->transform, ElementsAre(400000, 10, 0, 5200300, 0, -10));
    EXPECT_EQ(file.place->metres_per_unit, 1);
    EXPECT_TRUE(file.holes.empty());
    EXPECT_EQ(file.sample_type, std::string(name) == "b.grd" ? "64-bit floats" : "32-bit floats");
  }
}

TEST_F(Geo, OverviewsAndIntegersAndMasksAreRead) {
  gdal("gdal_translate -q -ot Int16 -a_nodata 530 a.tif i.tif && gdaladdo -q i.tif 2 4");
  const HeightFile file = read("i.tif");
  EXPECT_EQ(file.format, "GeoTIFF");
  EXPECT_EQ(file.sample_type, "16-bit signed integers");
  EXPECT_EQ(file.place->no_data, 530);
  ASSERT_FALSE(file.holes.empty());
  for (size_t i = 0; i < file.values.size(); ++i) {
    const double height = geo_height(static_cast<int>(i) % kGeoWidth, static_cast<int>(i) / kGeoWidth);
    EXPECT_EQ(file.holes[i], std::round(height) == 530) << height;
    EXPECT_EQ(file.values[i], file.holes[i] ? 0 : std::round(height));
  }
  gdal(
      "gdal_translate -q -of GTiff --config GDAL_TIFF_INTERNAL_MASK YES -mask 1 -a_nodata none -ot Byte "
      "a.tif m.tif");
  EXPECT_TRUE(read("m.tif").holes.empty());  // no height there is 0
}

TEST_F(Geo, NoDataMasksAndNonFiniteValuesAreHoles) {
  const auto only_first = [](const HeightFile& file) {
    return !file.holes.empty() && file.holes[0] == 1 && file.values[0] == 0 &&
           std::count(file.holes.values.begin(), file.holes.values.end(), 1) == 1;
  };
  write_bytes(folder_ / "h.asc", asc_text("-9999"));
  EXPECT_TRUE(only_first(read("h.asc")));
  gdal("gdal_translate -q -ot Float32 -a_srs EPSG:32632 -a_nodata none h.asc untagged.tif");
  EXPECT_TRUE(read("untagged.tif").holes.empty());
  HeightFileOptions options;
  options.no_data = -9999;
  EXPECT_TRUE(only_first(read("untagged.tif", options)));
  gdal(
      "gdalwarp -q -dstnodata nan -srcnodata -9999 untagged.tif nan.tif && "
      "gdal_translate -q -a_nodata none nan.tif untagged_nan.tif");
  EXPECT_TRUE(only_first(read("nan.tif")));
  EXPECT_TRUE(only_first(read("untagged_nan.tif")));
  gdal("gdalwarp -q -dstalpha -srcnodata -9999 untagged.tif alpha.tif");
  EXPECT_TRUE(only_first(read("alpha.tif")));
  write_vrt("none.vrt", "", "<NoDataValue>5</NoDataValue><Scale>1</Scale>", "missing.tif");
  EXPECT_THAT(refusal("none.vrt"), HasSubstr("none.vrt: cannot be read from row 0"));
}

TEST_F(Geo, ScaleOffsetAndUnitsOfHeightsGiveMetres) {
  write_vrt("scaled.vrt", "", "<Scale>0.5</Scale><Offset>100</Offset>");
  expect_heights(read("scaled.vrt"), 0.5, 100);
  write_vrt("feet.vrt", "", "<UnitType>ft</UnitType>");
  expect_heights(read("feet.vrt"), 0.3048);
  write_vrt("survey.vrt", "", "<Scale>0.5</Scale><Offset>100</Offset><UnitType>US survey foot</UnitType>");
  expect_heights(read("survey.vrt"), 0.5 * (1200.0 / 3937), 100 * (1200.0 / 3937));
  gdal("gdal_translate -q -a_srs EPSG:32632+6360 a.tif vertical.tif");  // NAVD88 in US survey feet
  expect_heights(read("vertical.tif"), 1200.0 / 3937);
  write_vrt("kelvin.vrt", "", "<UnitType>K</UnitType>");
  EXPECT_THAT(refusal("kelvin.vrt"), HasSubstr("its values are in 'K', expected heights in metres or feet"));
}

TEST_F(Geo, CoordinatesInFeetAndMercatorGiveTrueMetres) {
  gdal("gdal_translate -q -a_srs EPSG:2263 -a_ullr 980000 200300 980400 200000 a.tif feet.tif");
  EXPECT_NEAR(read("feet.tif").place->metres_per_unit, 1200.0 / 3937, 1e-12);
  for (const int latitude : {0, 30, 60}) {
    const double y = 6378137 * std::log(std::tan(std::numbers::pi / 4 + latitude * std::numbers::pi / 360));
    gdal(fmt::format("gdal_translate -q -a_srs EPSG:3857 -a_ullr 900000 {} 900400 {} a.tif mercator{}.tif",
                     y + 150, y - 150, latitude));
    // On a sphere 1/cos φ; the flattening moves it by .5 % at most.
    EXPECT_NEAR(read(fmt::format("mercator{}.tif", latitude)).place->metres_per_unit,
                std::cos(latitude * std::numbers::pi / 180), 0.005);
  }
  gdal("gdalwarp -q -t_srs EPSG:32662 a.tif plate.tif");
  EXPECT_THAT(refusal("plate.tif"),
              AllOf(HasSubstr("stretches texels"), HasSubstr("gdalwarp -t_srs EPSG:32632")));
}

TEST_F(Geo, RowsThatGoNorthAreTurned) {
  write_vrt("south.vrt", "<GeoTransform>400000,10,0,5200000,0,10</GeoTransform>",
            "<NoDataValue>-9999</NoDataValue>");
  const HeightFile file = read("south.vrt");
  expect_heights(file, 1, 0, true);
  EXPECT_EQ(file.place->transform[5], 10);
  write_vrt("turned.vrt", "<GeoTransform>400000,9,1,5200000,1,-9</GeoTransform>", "");
  EXPECT_THAT(refusal("turned.vrt"),
              AllOf(HasSubstr("turned against the coordinates"), HasSubstr("`gdalwarp ")));
  write_vrt("none.vrt", "<GeoTransform>0,0,0,0,0,0</GeoTransform>", "");
  EXPECT_THAT(refusal("none.vrt"), HasSubstr("its texels have no size"));
  write_vrt("mirrored.vrt", "<GeoTransform>400000,-10,0,5200000,0,-10</GeoTransform>", "");
  EXPECT_THAT(refusal("mirrored.vrt"), AllOf(HasSubstr("are mirrored"), HasSubstr("`gdalwarp ")));
}

TEST_F(Geo, DegreesAreRefusedWithTheProjectionOfTheirMiddle) {
  const struct {
    const char *corners, *expected;
  } places[] = {{"8 47 8.0333 46.975", "EPSG:32632 -tr 77 77"},
                {"-70 -33 -69.96 -33.03", "EPSG:32719 "},
                {"-180 1 -179.96 0.97", "EPSG:32601 "},
                {"179.96 1 180 0.97", "EPSG:32660 "},
                {"10 86 10.04 85.97", "lat_0=85.9850 +lon_0=10.0200 +datum=WGS84"},
                {"10 -85 10.04 -85.03", "lat_0=-85.0150 +lon_0=10.0200 +datum=WGS84"}};
  for (const auto& [corners, expected] : places) {
    gdal(fmt::format("gdal_translate -q -a_srs EPSG:4326 -a_ullr {} a.tif d.tif", corners));
    EXPECT_THAT(refusal("d.tif"), AllOf(HasSubstr("d.tif: is in degrees, expected metres: `gdalwarp -t_srs "),
                                        HasSubstr(expected)));
  }
  gdal("gdal_translate -q -a_srs '+proj=longlat +R=3396190' -a_ullr 8 47 8.0333 46.975 a.tif mars.tif");
  EXPECT_THAT(refusal("mars.tif"), HasSubstr("+R=3396190"));
  gdal("gdal_translate -q -a_srs EPSG:4326 -a_ullr -180 90 180 -90 a.tif world.tif");
  EXPECT_THAT(refusal("world.tif"), HasSubstr("gdal_translate -srcwin "));
  // Without a coordinate system, land steeper than any tells.
  write_bytes(folder_ / "bare_degrees.asc", asc_text("", 8, 47, 1.0 / 1200));
  EXPECT_THAT(refusal("bare_degrees.asc"), HasSubstr("`gdalwarp -s_srs EPSG:4326 -t_srs EPSG:32632 "));
}

TEST_F(Geo, SrtmIsRefusedWithALineThatHelps) {
  std::string tile;
  for (int i = 0; i < 1201 * 1201; ++i) tile += {static_cast<char>(1), static_cast<char>(i % 100)};
  write_bytes(folder_ / "S34W070.hgt", tile);
  EXPECT_THAT(refusal("S34W070.hgt"), HasSubstr("`gdalwarp -t_srs EPSG:32719 -tr "));
}

TEST_F(Geo, BandsAndVariablesAreChosenByName) {
  gdal("gdal_translate -q -b 1 -b 1 -b 1 -ot UInt16 -colorinterp red,green,blue a.tif rgb.tif");
  EXPECT_THAT(refusal("rgb.tif"), HasSubstr("a picture of 3 bands of colour"));
  HeightFileOptions options;
  options.channel = "2";
  EXPECT_EQ(read("rgb.tif", options).channel, "2");
  options.channel = "4";
  EXPECT_THAT(refusal("rgb.tif", options), HasSubstr("expected one of 1, 2, 3"));
  write_bytes(folder_ / "two.nc", classic_netcdf(7, 5, {"depth", "land"}));
  EXPECT_THAT(refusal("two.nc"),
              HasSubstr("two.nc: holds 2 variables, expected the name of one with channel: depth, land"));
  options.channel = "land";
  const HeightFile land = read("two.nc", options);
  EXPECT_EQ(land.values.width, 7);
  EXPECT_EQ(land.values[34], 1);
  EXPECT_FALSE(land.place);
  write_bytes(folder_ / "one.nc", classic_netcdf(7, 5, {"depth"}));
  EXPECT_EQ(read("one.nc").values[34], 0);
}

TEST_F(Geo, FilesCutShortAreRefused) {
  gdal(
      "gdal_translate -q -of COG a.tif c.tif && gdal_translate -q -of netCDF a.tif c.nc && "
      "gdal_translate -q -of EHdr a.tif c.bil && cp bare.asc c.asc && gdal_translate -q -of netCDF -co "
      "FORMAT=NC4 "
      "a.tif c4.nc");
  for (const char* name : {"a.tif", "c.tif", "c.nc", "c4.nc", "c.bil", "c.asc"}) {
    const std::string whole = read_bytes(folder_ / name), cut = std::string("cut") + name;
    std::filesystem::copy_file(folder_ / "c.hdr", folder_ / "cutc.hdr",
                               std::filesystem::copy_options::overwrite_existing);
    for (size_t part = 1; part < 24; ++part) {
      write_bytes(folder_ / cut, whole.substr(0, whole.size() * part / 24));
      EXPECT_THAT(refusal(cut), HasSubstr(cut)) << part;
    }
  }
}

TEST_F(Geo, SourcesThatAreNoFilesHereAreRefused) {
  for (const char* source :
       {"/vsicurl/http://127.0.0.1:9/a.tif", "http://127.0.0.1:9/a.tif", "/vsis3/bucket/a.tif"}) {
    write_vrt("url.vrt", "", "", source);
    EXPECT_THAT(refusal("url.vrt"), HasSubstr("names a source that is no file here")) << source;
  }
  ASSERT_EQ(mkfifo((folder_ / "pipe.tif").c_str(), 0600), 0);
  for (const std::string& source : {std::string("pipe.tif"), (folder_ / "pipe.tif").string(),
                                    std::string("/dev/zero"), std::string("/vsigzip//dev/zero")}) {
    write_vrt("pipe.vrt", "", "", source);
    EXPECT_THAT(refusal("pipe.vrt"), HasSubstr("names a source that is no regular file")) << source;
    write_vrt("outer.vrt", "", "", "pipe.vrt");
    EXPECT_THAT(refusal("outer.vrt"), HasSubstr("names a source that is no regular file")) << source;
  }
  write_vrt("self.vrt", "", "", "self.vrt");
  EXPECT_THAT(refusal("self.vrt"), HasSubstr("names itself"));
}

TEST_F(Geo, PlainImagesAreNotTerrain) {
  gdal(
      "gdal_translate -q -co PROFILE=BASELINE a.tif plain.tif && gdal_translate -q -of PNG -ot UInt16 a.tif "
      "p.png");
  EXPECT_FALSE(is_geo_file(folder_ / "plain.tif"));
  EXPECT_FALSE(read_geo_file(folder_ / "plain.tif", {}));
  EXPECT_FALSE(is_geo_file(folder_ / "p.png"));
  EXPECT_FALSE(is_geo_file(folder_ / "missing.hgt"));
  EXPECT_TRUE(is_geo_file(folder_ / "a.tif"));
  HeightFileOptions options;
  options.encoding = SplitEncoding::kTerrarium;
  EXPECT_FALSE(read_geo_file(folder_ / "a.tif", options));
}

TEST_F(Geo, WhatIsWrittenIsReadAgain) {
  const HeightFile source = read("a.tif");
  std::vector<float> values(source.values.size());
  for (size_t i = 0; i < values.size(); ++i)
    values[i] = static_cast<float>(i) / static_cast<float>(values.size());
  const Plane planes[] = {{"R", values.data()}, {"G", values.data()}, {"B", values.data()}};
  Grid<uint8_t> holes(kGeoWidth, kGeoHeight);
  holes[41] = 1;
  for (const double step : {-10.0, 10.0})
    for (const std::optional<double> no_data : {std::optional<double>(), {-32768.0}, {0.0}, {-1e300}}) {
      GeoPlace place = *source.place;
      place.no_data = no_data;
      place.transform[5] = step;
      for (const char* name : {"w.tif", "again.tif"}) {
        OutputFile file(folder_ / name);
        write_geo_tiff(file, kGeoWidth, kGeoHeight, planes, {place, holes}, {{"texture", "ao"}});
        file.commit();
      }
      EXPECT_EQ(read_bytes(folder_ / "w.tif"), read_bytes(folder_ / "again.tif"));
      HeightFileOptions second;
      second.channel = "2";
      const HeightFile back = read("w.tif", second);
      EXPECT_EQ(back.holes.values, holes.values);
      EXPECT_EQ(back.place->transform, place.transform);
      EXPECT_EQ(back.place->crs, place.crs);
      EXPECT_EQ(back.place->no_data, no_data && *no_data > -1e300 ? no_data : -9999);
      for (size_t i = 0; i < values.size(); ++i)
        EXPECT_NEAR(back.values[i], holes[i] ? 0 : values[i], std::numeric_limits<float>::denorm_min());
    }
}

TEST(GeoPlace, IsRecordedAndReadBack) {
  GeoPlace place;
  place.crs = "LOCAL_CS[\"x\"]";
  place.transform = {0.1, 1.0 / 3, 0, 5e6 + 1.0 / 7, 0, -1.0 / 3};
  for (const std::optional<double> no_data : {std::optional<double>(), {-9999.0}, {-3.4028234663852886e38}}) {
    place.no_data = no_data;
    Provenance provenance;
    record_place(place, provenance);
    check_provenance(provenance);
    const std::optional<GeoPlace> back = recorded_place(provenance);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->crs, place.crs);
    EXPECT_EQ(back->transform, place.transform);
    EXPECT_EQ(back->no_data, place.no_data);
  }
  place.no_data = std::numeric_limits<double>::quiet_NaN();
  Provenance provenance;
  record_place(place, provenance);
  EXPECT_TRUE(std::isnan(*recorded_place(provenance)->no_data));
  EXPECT_FALSE(recorded_place({{"version", "1"}}));
  for (const char* bad : {"", "1,2,3", "1,2,3,4,5,x", "1,2,3,4,5,6,7"})
    EXPECT_THAT(error_of<InputError>([&] {
                  recorded_place({{"geo_transform", bad}});
                }),
                HasSubstr("geo_transform"));
}

TEST(GeoPlace, LosesItsOuterRing) {
  GeoPlace place;
  place.transform = {100, 10, 0, 1000, 0, -20};
  EXPECT_THAT(place_without_ring(place, 3).transform, ElementsAre(130, 10, 0, 940, 0, -20));
}

}  // namespace
}  // namespace hemibake
