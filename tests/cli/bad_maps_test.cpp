// Maps and normal maps that cannot be baked, one by one.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "cli/run_hemibake.h"
#include "io/image_io.h"

namespace hemibake {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class BadMaps : public CliTest {
 protected:
  void SetUp() override { run_well("synth shapes --width 32 --height 32 -o map.png"); }

  // By both commands that read maps.
  void expect_bad_map(const std::string& map, const testing::Matcher<std::string>& line,
                      const std::string& options = "") const {
    expect_refusal(fmt::format("bake {} -o bake.exr --rays 4 {}", map, options), line);
    expect_refusal(fmt::format("run {} -o results --rays 4 {}", map, options), line);
  }

  // A float map with one value that write_image would not write: the bytes of a stored one are replaced.
  void write_map_with(const std::string& name, float bad) const {
    const float marker = 0.7654321f;
    Grid<float> heights(5, 4, 0.25f);
    heights(3, 2) = marker;
    write_height_map(folder_ / name, heights, make_provenance("test"));
    std::string bytes = read_bytes(folder_ / name);
    // Uncompressed: as written by a program that does not compress. OpenEXR may split the bytes of a float.
    const std::string old(reinterpret_cast<const char*>(&marker), sizeof marker);
    const size_t at = bytes.find(old);
    ASSERT_NE(at, std::string::npos) << "the value is not stored as it is";
    bytes.replace(at, old.size(), reinterpret_cast<const char*>(&bad), sizeof bad);
    write_bytes(folder_ / name, bytes);
  }
};

TEST_F(BadMaps, AreNamed) {
  expect_bad_map("none.png", "none.png: No such file or directory, expected an image");
  expect_bad_map(".", ".: is a folder, expected an image");
  write_bytes(folder_ / "empty.png", "");
  expect_bad_map("empty.png", "empty.png: is empty, expected an image");
  write_bytes(folder_ / "text.png", "This is a letter and no picture.\n\nIt has several lines.\n");
  expect_bad_map("text.png", AllOf(StartsWith("text.png: "), HasSubstr("expected")));
  write_bytes(folder_ / "text.exr", std::string(5000, 'x'));
  expect_bad_map("text.exr", AllOf(StartsWith("text.exr: "), HasSubstr("expected")));
  write_bytes(folder_ / "map.unknown", "x");
  expect_bad_map("map.unknown", AllOf(StartsWith("map.unknown: "), HasSubstr("expected")));
  expect_bad_map("map.png", AllOf(StartsWith("map.png: has no channel 'Z', expected"), EndsWith(": Y")),
                 "--channel Z");
}

TEST_F(BadMaps, CutShort) {
  run_well("synth shapes --width 32 --height 32 -o map.exr");
  for (const std::string name : {"map.png", "map.exr"}) {
    const std::string whole = read_bytes(folder_ / name);
    // In the signature, the header, the texels, and one byte before the end.
    for (const size_t length :
         {size_t{4}, size_t{20}, whole.size() / 4, whole.size() / 2, whole.size() - 1}) {
      write_bytes(folder_ / ("cut_" + name), whole.substr(0, length));
      expect_bad_map("cut_" + name, AllOf(StartsWith("cut_" + name + ": "), HasSubstr("expected")));
    }
  }
}

TEST_F(BadMaps, WithoutTexels) {
  // Width 0 in the header chunk of a PNG, and far too much: the CRC of the chunk then tells too.
  for (const std::string& width : {std::string(4, '\0'), std::string("\x7f\xff\xff\xff")}) {
    std::string bytes = read_bytes(folder_ / "map.png");
    write_bytes(folder_ / "size.png", bytes.replace(16, 4, width));
    expect_bad_map("size.png", AllOf(StartsWith("size.png: "), HasSubstr("expected")));
  }
}

TEST_F(BadMaps, ValuesThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), HUGE_VALF, -HUGE_VALF}) {
    write_map_with("bad.exr", bad);
    expect_bad_map("bad.exr", AllOf(StartsWith("bad.exr: "), HasSubstr("3,2"), HasSubstr("finite")));
  }
}

TEST_F(BadMaps, NeedTwoByTwoWithOpenEdges) {
  run_well("synth noise --width 8 --height 1 -o row.exr");
  expect_bad_map("row.exr", AllOf(StartsWith("row.exr: "), HasSubstr("expected")), "--edge open");
}

TEST_F(BadMaps, TooSteepForTheirSize) {
  expect_bad_map("map.png", AllOf(StartsWith("map.png: "), HasSubstr("expected")),
                 "--amplitude 1e9 --size 1e-9");
}

class BadNormals : public CliTest {
 protected:
  void SetUp() override {
    run_well("synth shapes --width 16 --height 16 -o map.png");
    write_normals("n.png", 16, 16, {0.5f, 0.5f, 1.0f});
  }

  void write_normals(const std::string& name, int width, int height, const glm::vec3& color) const {
    write_png8_rgb(folder_ / name, Grid<glm::vec3>(width, height, color), make_provenance("test"));
  }
  void expect_bad_normals(const std::string& options, const testing::Matcher<std::string>& line) const {
    expect_refusal("bake map.png -o bake.exr --rays 4 " + options, line);
    expect_refusal("run map.png -o results --rays 4 " + options, line);
  }
};

TEST_F(BadNormals, AreNamed) {
  expect_bad_normals("--normals n.png",
                     AllOf(StartsWith("n.png: "), HasSubstr("--normal-y up or --normal-y down")));
  expect_bad_normals("--normal-y up",
                     AllOf(StartsWith("--normal-y: "), HasSubstr("expected --normals FILE")));
  expect_bad_normals("--normals n.png --normal-y left",
                     AllOf(StartsWith("--normal-y: left"), HasSubstr("{up,down}")));
  expect_bad_normals("--normals n.png --normal-y up --normals-from faces", StartsWith("--normals-from: "));
  expect_bad_normals("--normals none.png --normal-y up", StartsWith("none.png: No such file"));
  write_normals("wide.png", 17, 16, {0.5f, 0.5f, 1.0f});
  expect_bad_normals("--normals wide.png --normal-y up",
                     AllOf(StartsWith("wide.png: "), HasSubstr("17 x 16"), HasSubstr("expected 16 x 16")));
  write_normals("below.png", 16, 16, {0.5f, 0.5f, 0.0f});
  expect_bad_normals("--normals below.png --normal-y up", AllOf(StartsWith("below.png: "), HasSubstr("0,0")));
  expect_bad_normals("--normals map.png --normal-y up",
                     AllOf(StartsWith("map.png: "), HasSubstr("expected")));
  run_well("bake map.png -o bake.exr --rays 4 --normals n.png --normal-y up");
}

}  // namespace
}  // namespace hemibake
