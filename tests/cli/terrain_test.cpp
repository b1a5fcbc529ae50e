// Terrain through the real binary: places are kept, and what cannot be used is refused with what helps.
#include <gmock/gmock.h>

#include "cli/run_hemibake.h"
#include "io/bake_file.h"
#include "io/geo_read.h"
#include "io/geo_testing.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* kQuick = " --rays 4 --edge open";

class TerrainFiles : public GeoTest {
 protected:
  CommandOutcome hemibake(const std::string& arguments) const {
    return run_command("cd '" + folder_.path().string() + "' && '" HEMIBAKE_BINARY "' " + arguments,
                       folder_.path());
  }
  void run_well(const std::string& arguments) const {
    const CommandOutcome outcome = hemibake(arguments);
    ASSERT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
  }
  std::string refusal(const std::string& arguments) const {
    const CommandOutcome outcome = hemibake(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  }
  nlohmann::json info(const std::string& name) const {
    return nlohmann::json::parse(gdal("gdalinfo -json '" + name + "'"));
  }

  // Expects coordinates, size and NoData of one raster in another.
  void expect_same_place(const std::string& made, const std::string& source) const {
    const nlohmann::json of_made = info(made), of_source = info(source);
    for (const char* key : {"geoTransform", "size", "coordinateSystem", "cornerCoordinates"})
      EXPECT_EQ(of_made[key], of_source[key]) << key << " of " << made;
    EXPECT_EQ(of_made["bands"][0].value("noDataValue", nlohmann::json()),
              of_source["bands"][0].value("noDataValue", nlohmann::json()));
    if (run_command("gdalcompare.py", folder_.path()).exit_code != 127) {
      const std::string differences =
          run_command("cd '" + folder_.path().string() + "' && gdalcompare.py " + source + " " + made,
                      folder_.path())
              .out;
      EXPECT_THAT(differences, HasSubstr("Differences Found"));
      for (const char* kind : {"SRS", "GeoTransforms", "nodata", "Size"})
        EXPECT_THAT(differences, Not(HasSubstr(kind))) << made;
    }
    EXPECT_EQ(of_made["metadata"]["IMAGE_STRUCTURE"]["COMPRESSION"], "DEFLATE");
    EXPECT_EQ(of_made["bands"][0]["block"], nlohmann::json({256, 256}));
  }
};

TEST_F(TerrainFiles, TexturesKeepThePlaceOfTheirMap) {
  gdal(
      "gdal_translate -q -a_nodata -9999 a.tif north.tif && gdal_translate -q -a_nodata none a.tif "
      "without.tif && "
      "gdal_translate -q -ot Int16 -a_nodata -32768 -a_srs EPSG:2056 a.tif swiss.tif && gdaladdo -q "
      "swiss.tif 2");
  write_vrt("southern.vrt", "<SRS>EPSG:32632</SRS><GeoTransform>400000,10,0,5200000,0,10</GeoTransform>",
            "<NoDataValue>-9999</NoDataValue>");
  gdal("gdal_translate -q southern.vrt south.tif");
  for (const char* map : {"north", "without", "swiss", "south"}) {
    SCOPED_TRACE(map);
    run_well(fmt::format("bake {0}.tif -o {0}.exr --outputs ao,bent{1}", map, kQuick));
    run_well(fmt::format("textures {0}.exr -o of_bake --maps ao,bent --format tif", map));
    run_well(fmt::format("textures {0}.tif -o of_map --maps ao --format tif{1}", map, kQuick));
    for (const char* made : {"of_bake/{}_ao.tif", "of_map/{}_ao.tif", "of_bake/{}_bent.tif"})
      expect_same_place(fmt::format(fmt::runtime(made), map), fmt::format("{}.tif", map));
    const Bake bake = read_bake(folder_ / fmt::format("{}.exr", map)).bake;
    const auto texture = read_geo_file(folder_ / fmt::format("of_bake/{}_ao.tif", map), {});
    ASSERT_TRUE(texture);
    EXPECT_EQ(texture->values.values, bake.visible_fraction.values);
    // As other programs count rows: from the first of the file.
    const bool south = std::string(map) == "south";
    const double value = std::stod(gdal(fmt::format("gdallocationinfo -valonly of_map/{}_ao.tif 7 2", map)));
    EXPECT_NEAR(value, bake.visible_fraction(7, south ? kGeoHeight - 3 : 2), 1e-6);
  }
}

TEST_F(TerrainFiles, BakesAreWrittenAsBands) {
  gdal("gdal_translate -q -a_nodata -9999 a.tif place.tif");
  run_well(fmt::format("bake place.tif -o b.exr --bounces 1{}", kQuick));
  run_well(fmt::format("bake place.tif -o b.tif --bounces 1{}", kQuick));
  expect_same_place("b.tif", "place.tif");
  const Bake bake = read_bake(folder_ / "b.exr").bake;
  const std::string value = gdal("gdallocationinfo -valonly -b 1 b.tif 7 2");
  EXPECT_NEAR(std::stod(value), bake.visible_fraction(7, 2), 1e-6);
  std::vector<std::string> names;
  const auto bands = info("b.tif")["bands"];
  for (const auto& band : bands) names.push_back(band["description"]);
  EXPECT_THAT(names, testing::IsSupersetOf({"ao", "visibility", "irradiance.00", "irradiance.01"}));
  EXPECT_THAT(refusal("curves b.tif -o c.csv"), HasSubstr("b.tif: bakes are read from EXR"));
  write_height_map(folder_ / "plain.exr", Grid<float>(8, 8, 0.5f), make_provenance("test"));
  run_well("bake plain.exr -o plain_bake.tif --rays 4");
  EXPECT_FALSE(info("plain_bake.tif").contains("geoTransform"));
  EXPECT_EQ(info("plain_bake.tif")["bands"][0]["description"], "ao");
}

TEST_F(TerrainFiles, TheCommandForDegreesGivesAMapThatBakes) {
  for (const char* corners : {"8 47 8.0333 46.975", "-70 -33 -69.96 -33.03", "10 86 10.4 85.97"}) {
    gdal(fmt::format(
        "rm -f out.tif && gdal_translate -q -a_nodata none -a_srs EPSG:4326 -a_ullr {} a.tif 'my deg.tif'",
        corners));
    const std::string line = refusal(fmt::format("bake 'my deg.tif' -o x.exr{}", kQuick));
    EXPECT_THAT(line, StartsWith("hemibake: my deg.tif: is in degrees, expected metres: `gdalwarp "));
    const size_t begin = line.find('`') + 1;
    gdal(line.substr(begin, line.find('`', begin) - begin));
    EXPECT_TRUE(read_geo_file(folder_ / "out.tif", {})->holes.empty()) << line;
    run_well(fmt::format("bake out.tif -o x.exr --outputs ao{}", kQuick));
  }
}

TEST_F(TerrainFiles, IsRefusedInOneLineThatNamesTheFile) {
  write_bytes(folder_ / "cut.tif", read_bytes(folder_ / "a.tif").substr(0, 3000));
  write_vrt("missing.vrt", "", "", "no.tif");
  write_vrt("url.vrt", "", "", "/vsicurl/http://127.0.0.1:9/a.tif");
  write_bytes(folder_ / "text.hgt", "hello");
  for (const char* name : {"cut.tif", "missing.vrt", "url.vrt", "text.hgt"}) {
    EXPECT_THAT(refusal(fmt::format("bake {} -o x.exr", name)),
                StartsWith(fmt::format("hemibake: {}: ", name)));
    EXPECT_THAT(refusal(fmt::format("textures {} -o out", name)),
                StartsWith(fmt::format("hemibake: {}: ", name)));
  }
}

TEST_F(TerrainFiles, IsFoundInFoldersAndDoneOnce) {
  gdal("mkdir maps && cp a.tif maps/ && gdal_translate -q -of EHdr a.tif maps/b.bil");
  const std::string line = fmt::format("textures maps -o out --maps ao --format tif{}", kQuick);
  run_well(line);
  expect_same_place("out/a_ao.tif", "maps/a.tif");
  EXPECT_EQ(info("out/b_ao.tif")["geoTransform"], info("maps/b.bil")["geoTransform"]);
  EXPECT_THAT(hemibake(line).out + hemibake(line).err,
              AllOf(HasSubstr("a.tif: done before"), HasSubstr("b.bil: done before")));
}

}  // namespace
}  // namespace hemibake
